package main

import (
	"math"
	"sort"
)

type Shape struct {
	Kind, Name     string
	Radius, Length float64
	Size           Vec
	Normal         Vec
	Offset         float64
	Vertices       []Vec
	Points         []Vec
}

type Distance struct {
	Phi   float64 `json:"phi"`
	Alpha Vec     `json:"alpha"`
	Beta  Vec     `json:"beta"`
	N     Vec     `json:"n"`
}

// Polytope is the hull of its vertices, blown up by a radius. Faces list their vertices in order.
type Polytope struct {
	vertices []Vec
	edges    [][2]int
	faces    [][]int
	normals  []Vec
	radius   float64
}

func corners(size Vec) (vertices []Vec) {
	for i := 0; i < 8; i++ {
		x := Vec{-size[0] / 2, -size[1] / 2, -size[2] / 2}
		for j := 0; j < 3; j++ {
			if i>>j&1 == 1 {
				x[j] = size[j] / 2
			}
		}
		vertices = append(vertices, x)
	}
	return
}

func polytope(shape Shape, pose Pose) Polytope {
	var local []Vec
	radius := shape.Radius
	switch shape.Kind {
	case "sphere":
		local = []Vec{{}}
	case "capsule":
		local = []Vec{{0, 0, -shape.Length / 2}, {0, 0, shape.Length / 2}}
	case "box":
		local = corners(shape.Size)
	case "convex":
		local = shape.Vertices
	default:
		panic(shape.Kind)
	}
	p := Polytope{radius: radius}
	if len(local) < 4 {
		p.edges = [][2]int{{0, len(local) - 1}}
	} else {
		p.faces, p.normals = hull(local)
		seen := map[[2]int]bool{}
		for _, face := range p.faces {
			for k, i := range face {
				j := face[(k+1)%len(face)]
				edge := [2]int{i, j}
				if i > j {
					edge = [2]int{j, i}
				}
				if !seen[edge] {
					seen[edge] = true
					p.edges = append(p.edges, edge)
				}
			}
		}
	}
	for _, x := range local {
		p.vertices = append(p.vertices, place(pose, x))
	}
	for i, m := range p.normals {
		p.normals[i] = rotate(pose.Quaternion, m)
	}
	return p
}

// hull is the faces of the hull of some points: their vertices, counterclockwise, and outward normals.
func hull(points []Vec) (faces [][]int, normals []Vec) {
	extent := 0.0
	for _, x := range points {
		extent = math.Max(extent, norm(sub(x, points[0])))
	}
	for i := range points {
		for j := range points {
			for k := range points {
				u, v := sub(points[j], points[i]), sub(points[k], points[i])
				m := cross(u, v)
				if i >= j || i >= k || norm(m) <= 1e-9*norm(u)*norm(v) {
					continue
				}
				m = unit(m)
				face := []int{}
				for l, x := range points {
					height := dot(m, sub(x, points[i]))
					if height > 1e-9*extent {
						face = nil
						break
					}
					if height > -1e-9*extent {
						face = append(face, l)
					}
				}
				known := false
				for _, other := range normals {
					known = known || dot(other, m) > 1-1e-9
				}
				if face != nil && !known {
					faces, normals = append(faces, around(points, face, m)), append(normals, m)
				}
			}
		}
	}
	return
}

// around sorts the points of a face by their angle about its normal, those inside it left out.
func around(points []Vec, face []int, m Vec) (corners []int) {
	centre := Vec{}
	for _, i := range face {
		centre = along(centre, points[i], 1/float64(len(face)))
	}
	d1, d2 := tangents(m)
	angle := func(i int) float64 {
		x := sub(points[i], centre)
		return math.Atan2(dot(x, d2), dot(x, d1))
	}
	sort.Slice(face, func(a, b int) bool { return angle(face[a]) < angle(face[b]) })
	return face
}

// segments is the closest points of a + s u and b + t v, s and t from 0 to 1.
// Where both lie within, n is across both, else 0.
func segments(a, u, b, v Vec) (x, y, n Vec) {
	clip := func(x float64) float64 { return math.Max(0, math.Min(1, x)) }
	w := sub(a, b)
	uu, vv := dot(u, u), dot(v, v)
	s, t := 0.0, 0.0
	if m := cross(u, v); dot(m, m) > 1e-24*uu*vv {
		s = clip(dot(cross(v, w), m) / dot(m, m))
	}
	if vv > 0 {
		t = clip(dot(v, along(w, u, s)) / vv)
	}
	if uu > 0 {
		s = clip(dot(u, sub(scale(t, v), w)) / uu)
	}
	if vv > 0 {
		t = clip(dot(v, along(w, u, s)) / vv)
	}
	x, y = along(a, u, s), along(b, v, t)
	if m := cross(u, v); s*(1-s) > 0 && t*(1-t) > 0 && norm(m) > 1e-9*norm(u)*norm(v) {
		n = scale(math.Copysign(1, dot(m, sub(y, x))), unit(m))
	}
	return
}

// foot is the foot of x on the plane of a face, and whether it lies in the face.
func foot(p Polytope, f int, x Vec) (Vec, bool) {
	face, m := p.faces[f], p.normals[f]
	y := along(x, m, dot(m, sub(p.vertices[face[0]], x)))
	for k, i := range face {
		j := face[(k+1)%len(face)]
		side := cross(m, sub(p.vertices[j], p.vertices[i]))
		if dot(side, sub(y, p.vertices[i])) < -1e-14*norm(side) {
			return y, false
		}
	}
	return y, true
}

// apart is the closest points of two polytopes that do not touch, without their radii.
func apart(p, q Polytope) Distance {
	best := Distance{Phi: math.Inf(1)}
	keep := func(a, b Vec, n Vec) {
		d := sub(b, a)
		if n == (Vec{}) && norm(d) > 0 {
			n = unit(d)
		}
		if phi := dot(n, d); phi < best.Phi-1e-15 && phi > 1e-14 {
			best = Distance{phi, a, b, n}
		}
	}
	for f, m := range p.normals {
		for _, x := range q.vertices {
			if y, inside := foot(p, f, x); inside {
				keep(y, x, m)
			}
		}
	}
	for f, m := range q.normals {
		for _, x := range p.vertices {
			if y, inside := foot(q, f, x); inside {
				keep(x, y, scale(-1, m))
			}
		}
	}
	for _, e := range p.edges {
		for _, f := range q.edges {
			a, b := p.vertices[e[0]], q.vertices[f[0]]
			u, v := sub(p.vertices[e[1]], a), sub(q.vertices[f[1]], b)
			x, y, n := segments(a, u, b, v)
			keep(x, y, n)
		}
	}
	return best
}

// separation is the largest over all directions: that of a face's normal, or across two edges.
func separation(p, q Polytope) (phi float64, n Vec) {
	phi = math.Inf(-1)
	try := func(m Vec, more float64) {
		nearest, farthest := math.Inf(1), math.Inf(-1)
		for _, x := range q.vertices {
			nearest = math.Min(nearest, dot(m, x))
		}
		for _, x := range p.vertices {
			farthest = math.Max(farthest, dot(m, x))
		}
		if nearest-farthest > phi+more {
			phi, n = nearest-farthest, m
		}
	}
	for _, m := range p.normals {
		try(m, 0)
	}
	for _, m := range q.normals {
		try(scale(-1, m), 0)
	}
	for _, e := range p.edges {
		for _, f := range q.edges {
			u, v := sub(p.vertices[e[1]], p.vertices[e[0]]), sub(q.vertices[f[1]], q.vertices[f[0]])
			m := cross(u, v)
			if norm(m) > 1e-9*norm(u)*norm(v) {
				try(unit(m), 1e-12)
				try(scale(-1, unit(m)), 1e-12)
			}
		}
	}
	return
}

func between(p, q Polytope) Distance {
	found := Distance{}
	phi, n := separation(p, q)
	solid := len(p.faces)+len(q.faces) > 0
	if !solid {
		found = apart(p, q)
	}
	if solid && phi > 1e-13 {
		found = apart(p, q)
	} else if solid || math.IsInf(found.Phi, 1) {
		if !solid {
			phi, n = 0, transverse(p, q)
		}
		away := scale(1-phi, n)
		moved := q
		moved.vertices = nil
		for _, x := range q.vertices {
			moved.vertices = append(moved.vertices, add(x, away))
		}
		found = apart(p, moved)
		found = Distance{phi, found.Alpha, sub(found.Beta, away), n}
	}
	return blown(found, p.radius, q.radius)
}

// transverse is a direction across two segments or points that meet.
func transverse(p, q Polytope) Vec {
	u := sub(p.vertices[len(p.vertices)-1], p.vertices[0])
	v := sub(q.vertices[len(q.vertices)-1], q.vertices[0])
	if m := cross(u, v); norm(m) > 1e-9*norm(u)*norm(v) {
		return unit(m)
	}
	if sum := add(u, v); norm(sum) > 0 {
		d1, _ := tangents(unit(sum))
		return d1
	}
	return axis(0)
}

func blown(d Distance, first, second float64) Distance {
	return Distance{d.Phi - first - second, along(d.Alpha, d.N, first), along(d.Beta, d.N, -second), d.N}
}

func swapped(d Distance) Distance { return Distance{d.Phi, d.Beta, d.Alpha, scale(-1, d.N)} }

// above is the distance from a half-space to the support point x, along its normal, of a solid.
func above(plane Shape, pose Pose, support func(Vec) Vec) Distance {
	length := norm(plane.Normal)
	n := rotate(pose.Quaternion, scale(1/length, plane.Normal))
	x := support(scale(-1, n))
	phi := dot(n, sub(x, pose.Xyz)) - plane.Offset/length
	return Distance{phi, along(x, n, -phi), x, n}
}

// round is the distance from a cylinder to a point.
func round(can Shape, pose Pose, x Vec) Distance {
	y := rotate(conjugate(pose.Quaternion), sub(x, pose.Xyz))
	rho := math.Hypot(y[0], y[1])
	out := Vec{1, 0, 0}
	if rho > 0 {
		out = Vec{y[0] / rho, y[1] / rho, 0}
	}
	top := Vec{0, 0, math.Copysign(1, y[2])}
	side, cap := rho-can.Radius, math.Abs(y[2])-can.Length/2
	n, phi := out, side
	if side > 0 && cap > 0 {
		phi = math.Hypot(side, cap)
		n = add(scale(side/phi, out), scale(cap/phi, top))
	} else if cap > side {
		n, phi = top, cap
	}
	n = rotate(pose.Quaternion, n)
	return Distance{phi, along(x, n, -phi), x, n}
}

func distance(alpha, beta Shape, at, bt Pose) Distance {
	switch {
	case beta.Kind == "halfspace", beta.Kind == "cylinder" && alpha.Kind == "sphere":
		return swapped(distance(beta, alpha, bt, at))
	case alpha.Kind == "halfspace" && beta.Kind == "cylinder":
		return above(alpha, at, func(n Vec) Vec {
			m := rotate(conjugate(bt.Quaternion), n)
			rho := math.Hypot(m[0], m[1])
			y := Vec{0, 0, math.Copysign(beta.Length/2, m[2])}
			if rho > 0 {
				y[0], y[1] = beta.Radius*m[0]/rho, beta.Radius*m[1]/rho
			}
			return place(bt, y)
		})
	case alpha.Kind == "halfspace":
		p := polytope(beta, bt)
		return above(alpha, at, func(n Vec) Vec {
			best := p.vertices[0]
			for _, x := range p.vertices {
				if dot(n, x) > dot(n, best) {
					best = x
				}
			}
			return along(best, n, p.radius)
		})
	case alpha.Kind == "cylinder" && beta.Kind == "sphere":
		return blown(round(alpha, at, bt.Xyz), 0, beta.Radius)
	}
	return between(polytope(alpha, at), polytope(beta, bt))
}

// distances is those of all points, where one of the two shapes is a cloud.
func distances(alpha, beta Shape, at, bt Pose) (found []Distance) {
	point := Shape{Kind: "sphere"}
	if alpha.Kind == "cloud" {
		for _, x := range alpha.Points {
			found = append(found, distance(point, beta, Pose{place(at, x), at.Quaternion}, bt))
		}
		return
	}
	for _, x := range beta.Points {
		found = append(found, distance(alpha, point, at, Pose{place(bt, x), bt.Quaternion}))
	}
	return
}
