package main

import (
	"math"
	"sort"
)

type Placed struct {
	Shape Shape
	Pose  Pose
	Body  *string
}

type Pair struct {
	Name, Alpha, Beta string
	K, Rows           int
	Mu_v, Mu_omega    float64
	Compliance        *float64
}

type Load struct {
	Body          string
	Force, Torque Vec
}

type Scene struct {
	Mechanism Mechanism
	Q         []float64
	Q_bar_a   []float64
	K_q       [][]float64
	H         float64
	Cone      string
	Gravity   Vec
	Shapes    map[string]Placed
	Pairs     []Pair
	Wrenches  []Load
}

// Candidate is a distance that may become a contact; some come behind all others.
type Candidate struct {
	Distance
	index  int
	behind bool
}

// withoutRepeats keeps the first of equal points; -0 equals 0.
func withoutRepeats(points []Vec) (kept []Vec) {
	before := map[Vec]bool{}
	for _, x := range points {
		if !before[x] {
			kept = append(kept, x)
		}
		before[x] = true
	}
	return
}

func candidates(alpha, beta Shape, at, bt Pose, k int) (found []Candidate) {
	alpha.Points = withoutRepeats(alpha.Points)
	beta.Points = withoutRepeats(beta.Points)
	if alpha.Kind == "cloud" || beta.Kind == "cloud" {
		for i, d := range distances(alpha, beta, at, bt) {
			found = append(found, Candidate{Distance: d, index: i})
		}
		if beta.Kind == "cloud" {
			tied(alpha, at, found)
			return
		}
		for i := range found {
			found[i].Distance = swapped(found[i].Distance)
		}
		tied(beta, bt, found)
		for i := range found {
			found[i].Distance = swapped(found[i].Distance)
		}
		return
	}
	closest := Candidate{Distance: distance(alpha, beta, at, bt)}
	if k == 1 {
		return []Candidate{closest}
	}
	for _, x := range vertices(alpha) {
		d := swapped(corner(beta, bt, place(at, x), scale(-1, closest.N)))
		found = append(found, Candidate{Distance: d, index: len(found)})
	}
	for _, x := range vertices(beta) {
		d := corner(alpha, at, place(bt, x), closest.N)
		found = append(found, Candidate{Distance: d, index: len(found)})
	}
	last := len(found)
	closest.index = last
	number := last + 1
	if alpha.Kind == "box" && beta.Kind == "box" {
		found = append(found, crossings(alpha, beta, at, bt, closest.Distance, k)...)
		number += 8
	}
	found = facing(append(found, closest), closest.N)
	if least := smaller(alpha, beta); spanned(found, least) {
		found = found[:len(found)-1]
	}
	for i, c := range found {
		for _, d := range found[:i] {
			if math.Abs(c.Phi-d.Phi) <= 1e-9 && norm(sub(c.Alpha, d.Alpha)) <= 1e-9 && norm(sub(c.N, d.N)) <= 1e-6 {
				found[i].behind = true
			}
		}
	}
	far := Candidate{closest.Distance, last, true}
	far.Phi = 1e6
	for len(found) < k && len(found) < number {
		far.index++
		found = append(found, far)
	}
	return
}

// tied gives the points of a cloud, beta, that are as high over several faces of a solid as over the highest, and not outside,
// the normal of the face above which the whole cloud's least height is the largest.
func tied(solid Shape, pose Pose, cloud []Candidate) {
	if solid.Kind != "box" && solid.Kind != "convex" {
		return
	}
	p := polytope(solid, pose)
	height := func(f int, x Vec) float64 { return dot(p.normals[f], sub(x, p.vertices[p.faces[f][0]])) }
	least := make([]float64, len(p.normals))
	for f := range least {
		least[f] = math.Inf(1)
		for _, c := range cloud {
			least[f] = math.Min(least[f], height(f, c.Beta))
		}
	}
	for i, c := range cloud {
		highest, best := math.Inf(-1), -1
		for f := range least {
			highest = math.Max(highest, height(f, c.Beta))
		}
		for f := range least {
			if height(f, c.Beta) >= highest-1e-12 && (best < 0 || least[f] > least[best]) {
				best = f
			}
		}
		if n := p.normals[best]; highest <= 1e-12 && norm(sub(n, c.N)) > 1e-6 {
			cloud[i].Distance = Distance{c.Phi, sub(c.Beta, scale(c.Phi, n)), c.Beta, n}
		}
	}
}

// extent is the longest edge of the box about a shape along its axes, smaller that of the smaller one.
func extent(shape Shape) float64 {
	points := shape.Points
	switch shape.Kind {
	case "halfspace":
		return math.Inf(1)
	case "box":
		return math.Max(shape.Size[0], math.Max(shape.Size[1], shape.Size[2]))
	case "sphere", "capsule":
		return shape.Length + 2*shape.Radius
	case "cylinder":
		return math.Max(shape.Length, 2*shape.Radius)
	case "convex":
		points = shape.Vertices
	}
	longest := 0.0
	for i := 0; i < 3; i++ {
		low, high := math.Inf(1), math.Inf(-1)
		for _, x := range points {
			low, high = math.Min(low, x[i]), math.Max(high, x[i])
		}
		longest = math.Max(longest, high-low)
	}
	return longest
}

func smaller(alpha, beta Shape) float64 {
	least := math.Inf(1)
	for _, shape := range []Shape{alpha, beta} {
		if size := extent(shape); size > 0 {
			least = math.Min(least, size)
		}
	}
	if math.IsInf(least, 1) {
		return 0
	}
	return least
}

// rank is the number of the multiple of 1e-9 of the smaller size that a distance is next to.
func rank(phi, least float64) float64 {
	if least == 0 {
		return phi
	}
	return math.RoundToEven(phi / (1e-9 * least))
}

// spanned is whether the last one, the closest pair, is in the hull of others as near and of its normal:
// whether they are not all beyond it towards one of them or across a line through two.
func spanned(found []Candidate, least float64) bool {
	last := found[len(found)-1]
	level := []Vec{}
	for _, c := range found[:len(found)-1] {
		turned := sub(c.N, last.N)
		if c.Phi <= last.Phi+1e-9*least && math.Max(math.Abs(turned[0]), math.Max(math.Abs(turned[1]), math.Abs(turned[2]))) <= 1e-6 {
			level = append(level, sub(c.Alpha, last.Alpha))
		}
	}
	ways := append([]Vec{}, level...)
	for _, x := range level {
		for _, y := range level {
			ways = append(ways, cross(last.N, sub(x, y)))
		}
	}
	for _, way := range ways {
		beyond := math.Inf(1)
		for _, x := range level {
			beyond = math.Min(beyond, dot(way, x))
		}
		if beyond > 1e-6*least*norm(way) {
			return false
		}
	}
	return len(level) > 0
}

// facing is those whose normal is within 0.25 rad of n.
func facing(all []Candidate, n Vec) (found []Candidate) {
	for _, c := range all {
		if dot(c.N, n) >= math.Cos(0.25) {
			found = append(found, c)
		}
	}
	return
}

// corner is the distance from a solid to a corner x of another, the closest pair's normal being n.
func corner(solid Shape, pose Pose, x, n Vec) Distance {
	d := distance(solid, Shape{Kind: "sphere"}, pose, Pose{x, pose.Quaternion})
	if solid.Kind != "box" {
		return d
	}
	local, towards := rotate(conjugate(pose.Quaternion), sub(x, pose.Xyz)), rotate(conjugate(pose.Quaternion), n)
	ways := []Vec{towards}
	for i := range towards {
		if math.Abs(towards[i]) >= math.Cos(0.25) {
			ways = append(ways, scale(math.Copysign(1, towards[i]), axis(i)))
		}
	}
	for _, way := range ways {
		gap := dot(way, local)
		for i := range way {
			gap -= math.Abs(way[i]) * solid.Size[i] / 2
		}
		foot, excess := along(local, way, -gap), gap
		for i := range foot {
			excess = math.Max(excess, math.Abs(foot[i])-solid.Size[i]/2)
		}
		if excess <= 1e-9*math.Max(solid.Size[0], math.Max(solid.Size[1], solid.Size[2])) {
			m := rotate(pose.Quaternion, way)
			d = Distance{gap, along(x, m, -gap), x, m}
		}
	}
	return d
}

// Edge of a box, of length one from a corner; it may bear against n at a point of the surface.
type Edge struct {
	number  int
	from, u Vec
	length  float64
}

func bearing(box Shape, pose Pose, x, n Vec) (found []Edge) {
	local, towards := rotate(conjugate(pose.Quaternion), sub(x, pose.Xyz)), rotate(conjugate(pose.Quaternion), n)
	longest := math.Max(box.Size[0], math.Max(box.Size[1], box.Size[2]))
	number := 0
	for a := 0; a < 3; a++ {
		for i, corner := range corners(box.Size) {
			if i>>a&1 == 1 {
				continue
			}
			hold, steep := 0, false
			for b := 0; b < 3; b++ {
				if b != a && math.Abs(local[b]-corner[b]) <= 1e-9*longest {
					hold++
					steep = steep || math.Copysign(1, corner[b])*towards[b] >= math.Cos(0.25)
				}
			}
			if steep || hold == 2 && math.Abs(towards[a]) <= math.Sin(0.25) {
				found = append(found, Edge{number, place(pose, corner), rotate(pose.Quaternion, axis(a)), box.Size[a]})
			}
			number++
		}
	}
	return
}

func crossings(alpha, beta Shape, at, bt Pose, closest Distance, k int) (found []Candidate) {
	n := closest.N
	for _, e := range bearing(alpha, at, closest.Alpha, n) {
		for _, f := range bearing(beta, bt, closest.Beta, scale(-1, n)) {
			across, between := dot(cross(e.u, f.u), n), sub(f.from, e.from)
			if math.Abs(across) <= 1e-6 {
				continue
			}
			s, t := dot(cross(between, f.u), n)/across, dot(cross(between, e.u), n)/across
			if s < 0 || s > e.length || t < 0 || t > f.length {
				continue
			}
			first, second := along(e.from, e.u, s), along(f.from, f.u, t)
			d := Distance{dot(n, sub(second, first)), first, second, n}
			index := 16 + 2*(12*e.number+f.number)
			if k < 25 {
				index += k
			} else {
				index += 25
			}
			found = append(found, Candidate{Distance: d, index: index})
		}
	}
	return
}

func vertices(shape Shape) []Vec {
	switch shape.Kind {
	case "box":
		return corners(shape.Size)
	case "convex":
		return shape.Vertices
	}
	return nil
}

func contactsOf(scene Scene, found map[string]Frame, n_v int) []Contact {
	contacts := []Contact{}
	for _, pair := range scene.Pairs {
		alpha, beta := scene.Shapes[pair.Alpha], scene.Shapes[pair.Beta]
		at, bt := placed(alpha, found), placed(beta, found)
		near := candidates(alpha.Shape, beta.Shape, at, bt, pair.K)
		least := smaller(alpha.Shape, beta.Shape)
		sort.SliceStable(near, func(i, j int) bool {
			if near[i].behind != near[j].behind {
				return near[j].behind
			}
			one, other := rank(near[i].Phi, least), rank(near[j].Phi, least)
			if one != other {
				return one < other
			}
			return near[i].index < near[j].index
		})
		if len(near) > pair.K {
			near = near[:pair.K]
		}
		sort.Slice(near, func(i, j int) bool { return near[i].index < near[j].index })
		for _, d := range near {
			c := Contact{Touch: Touch{Pair: pair.Name, Index: d.index, Phi: d.Phi, Alpha: d.Alpha, Beta: d.Beta, N: d.N}}
			c.Alpha_body, c.Beta_body = alpha.Body, beta.Body
			c.Mu_v, c.Mu_omega, c.Rows = pair.Mu_v, pair.Mu_omega, pair.Rows
			c.D1, c.D2 = tangents(c.N)
			c.J = jacobian(c, found, n_v)
			contacts = append(contacts, c)
		}
	}
	return contacts
}

func placed(shape Placed, found map[string]Frame) Pose {
	world := Pose{Quaternion: Quat{0, 0, 0, 1}}
	if shape.Body != nil {
		world = found[*shape.Body].Pose
	}
	return compose(world, shape.Pose)
}

// dynamics is H = blockdiag(h K_q, M_u / h) and g = h (K_q delta_q_bar_a + tau_a, tau_u).
func dynamics(scene Scene, found map[string]Frame) (H [][]float64, g []float64) {
	o := order(scene.Mechanism)
	H, g = make([][]float64, o.n_v), make([]float64, o.n_v)
	for i := range H {
		H[i] = make([]float64, o.n_v)
	}
	for _, body := range scene.Mechanism.Bodies {
		frame := found[body.Name]
		linear, angular := velocities(frame, place(frame.Pose, body.Com), o.n_v)
		for i := o.n_a; i < o.n_v; i++ {
			local := rotate(conjugate(frame.Quaternion), angular[i])
			for j := o.n_a; j < o.n_v; j++ {
				other := rotate(conjugate(frame.Quaternion), angular[j])
				turned := Vec{dot(body.Inertia[0], other), dot(body.Inertia[1], other), dot(body.Inertia[2], other)}
				H[i][j] += (body.Mass*dot(linear[i], linear[j]) + dot(local, turned)) / scene.H
			}
			g[i] += scene.H * body.Mass * dot(linear[i], scene.Gravity)
		}
		for _, load := range scene.Wrenches {
			if load.Body == body.Name {
				for i := range g {
					g[i] += scene.H * (dot(linear[i], load.Force) + dot(angular[i], load.Torque))
				}
			}
		}
	}
	delta_q_bar_a := difference(scene.Mechanism, scene.Q_bar_a, scene.Q)
	for i := 0; i < o.n_a; i++ {
		for j := 0; j < o.n_a; j++ {
			H[i][j] = scene.H * scene.K_q[i][j]
			g[i] += scene.H * scene.K_q[i][j] * delta_q_bar_a[j]
		}
	}
	return
}

// forces are those of the step in which each contact gives way by its compliance.
func forces(scene Scene, contacts []Contact, compliances []float64, program *Program) [][4]float64 {
	S := [][]Number{}
	var contact []int
	var ways [][]float64
	for j, c := range contacts {
		for _, t := range cone(scene.Cone, c.Rows) {
			contact = append(contact, j)
			ways = append(ways, []float64{1, t[0], t[1], t[2]})
		}
	}
	for i := range program.S {
		line := append([]Number{}, program.S[i]...)
		for k := range line {
			if contact[i] == contact[k] {
				stiffness := number(scene.H / compliances[contact[i]])
				line[k] = plus(line[k], over(inner(numbers(ways[i]), numbers(ways[k])), stiffness))
			}
		}
		S = append(S, line)
	}
	lam, _ := multipliers(S, program.s)
	found := make([][4]float64, len(contacts))
	for j, c := range contacts {
		give := [4]Number{number(0), number(0), number(0), number(0)}
		for i := range lam {
			if contact[i] == j {
				for a := range give {
					give[a] = plus(give[a], times(number(ways[i][a]), lam[i]))
				}
			}
		}
		force := func(mu float64, s Number) float64 {
			stiffness := number(scene.H / compliances[j])
			return float(over(times(number(mu), over(s, stiffness)), number(compliances[j])))
		}
		found[j] = [4]float64{force(c.Mu_v, give[1]), force(c.Mu_v, give[2]), force(1, give[0]), force(c.Mu_omega, give[3])}
	}
	return found
}

func step(scene Scene) map[string]any {
	o := order(scene.Mechanism)
	found := frames(scene.Mechanism, scene.Q)
	contacts := contactsOf(scene, found, o.n_v)
	A, b := frictionRows(scene.Cone, contacts)
	H, g := dynamics(scene, found)
	program := &Program{H: H, G: g, A: A, B: b}
	answer := program.optimum()
	delete(answer, "slack")
	touches := []Touch{}
	for _, c := range contacts {
		touches = append(touches, c.Touch)
	}
	answer["contacts"], answer["H"], answer["g"], answer["A"], answer["b"] = touches, H, g, A, b
	lam, solved := answer["lam"].([]float64)
	if !solved {
		return answer
	}
	at := 0
	wrenches := make([][4]float64, len(contacts))
	compliances := make([]float64, len(contacts))
	for j, c := range contacts {
		c.Lam = lam[at : at+len(cone(scene.Cone, c.Rows))]
		at += len(c.Lam)
		wrenches[j] = wrench(scene.Cone, c, scene.H)
		compliances[j] = 1e-9
		for _, pair := range scene.Pairs {
			if pair.Name == c.Pair && pair.Compliance != nil {
				compliances[j] = *pair.Compliance
			}
		}
	}
	answer["wrench"] = wrenches
	answer["forces"] = forces(scene, contacts, compliances, program)
	answer["q_next"] = integrated(scene.Mechanism, scene.Q, answer["delta_q"].([]float64))
	return answer
}
