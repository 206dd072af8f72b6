package main

import "math"

type Mimic struct {
	Of                 string
	Multiplier, Offset float64
}

type Body struct {
	Name      string
	Parent    *string
	Placement Pose
	Joint     string
	Axis      Vec
	Actuated  bool
	Mass      float64
	Com       Vec
	Inertia   [3]Vec
	Mimic     *Mimic
}

type Mechanism struct{ Bodies []Body }

var sizes = map[string][2]int{"fixed": {0, 0}, "revolute": {1, 1}, "prismatic": {1, 1}, "continuous": {2, 1}, "floating": {7, 6}, "planar": {4, 3}}

// Order is where the entries of each body with a joint of its own begin in q and in delta_q.
type Order struct {
	q, v                    map[string]int
	n_q, n_a, n_v, actuated int
}

func order(mechanism Mechanism) Order {
	o := Order{q: map[string]int{}, v: map[string]int{}}
	for _, actuated := range []bool{true, false} {
		for _, body := range mechanism.Bodies {
			if body.Mimic == nil && body.Actuated == actuated {
				o.q[body.Name], o.v[body.Name] = o.n_q, o.n_v
				o.n_q += sizes[body.Joint][0]
				o.n_v += sizes[body.Joint][1]
			}
		}
		if actuated {
			o.n_a, o.actuated = o.n_v, o.n_q
		}
	}
	return o
}

// Mover is what one entry of delta_q does: a point x moves by shift + turn x (x - at).
type Mover struct {
	column          int
	shift, turn, at Vec
}

type Frame struct {
	Pose
	movers []Mover
}

func frames(mechanism Mechanism, q []float64) map[string]Frame {
	o := order(mechanism)
	found := map[string]Frame{}
	for _, body := range mechanism.Bodies {
		base := Frame{Pose: Pose{Quaternion: Quat{0, 0, 0, 1}}}
		if body.Parent != nil {
			base = found[*body.Parent]
		}
		origin := compose(base.Pose, body.Placement)
		movers := append([]Mover{}, base.movers...)
		column, factor, offset := o.v[body.Name], 1.0, 0.0
		entries := q[o.q[body.Name]:]
		if body.Mimic != nil {
			column, factor, offset = o.v[body.Mimic.Of], body.Mimic.Multiplier, body.Mimic.Offset
			entries = q[o.q[body.Mimic.Of]:]
		}
		pose := origin
		switch body.Joint {
		case "revolute", "continuous":
			a := unit(body.Axis)
			angle := 0.0
			if body.Joint == "continuous" {
				angle = math.Atan2(entries[1], entries[0])
			} else {
				angle = factor*entries[0] + offset
			}
			pose = compose(origin, Pose{Quaternion: turn(a, angle)})
			movers = append(movers, Mover{column: column, turn: scale(factor, rotate(origin.Quaternion, a)), at: origin.Xyz})
		case "prismatic":
			a := unit(body.Axis)
			pose = compose(origin, Pose{scale(factor*entries[0]+offset, a), Quat{0, 0, 0, 1}})
			movers = append(movers, Mover{column: column, shift: scale(factor, rotate(origin.Quaternion, a))})
		case "floating":
			pose = compose(origin, Pose{Vec{entries[0], entries[1], entries[2]}, Quat{entries[3], entries[4], entries[5], entries[6]}})
			for i := 0; i < 3; i++ {
				e := rotate(pose.Quaternion, axis(i))
				movers = append(movers, Mover{column: column + i, shift: e}, Mover{column: column + 3 + i, turn: e, at: pose.Xyz})
			}
		case "planar":
			pose = compose(origin, Pose{Vec{entries[0], entries[1], 0}, turn(axis(2), math.Atan2(entries[3], entries[2]))})
			for i := 0; i < 2; i++ {
				movers = append(movers, Mover{column: column + i, shift: rotate(pose.Quaternion, axis(i))})
			}
			movers = append(movers, Mover{column: column + 2, turn: rotate(pose.Quaternion, axis(2)), at: pose.Xyz})
		}
		found[body.Name] = Frame{pose, movers}
	}
	return found
}

// velocities are the columns of the Jacobians of a material point and of the turn of a frame.
func velocities(frame Frame, x Vec, n_v int) (linear, angular []Vec) {
	linear, angular = make([]Vec, n_v), make([]Vec, n_v)
	for _, m := range frame.movers {
		linear[m.column] = add(linear[m.column], add(m.shift, cross(m.turn, sub(x, m.at))))
		angular[m.column] = add(angular[m.column], m.turn)
	}
	return
}

// integrated is q (+) delta_q.
func integrated(mechanism Mechanism, q, delta_q []float64) []float64 {
	o := order(mechanism)
	moved := make([]float64, o.n_q)
	for _, body := range mechanism.Bodies {
		if body.Mimic != nil || body.Joint == "fixed" {
			continue
		}
		at, by, to := q[o.q[body.Name]:], delta_q[o.v[body.Name]:], moved[o.q[body.Name]:]
		switch body.Joint {
		case "revolute", "prismatic":
			to[0] = at[0] + by[0]
		case "continuous":
			turned(to, at, by[0])
		case "floating":
			pose := Pose{Vec{at[0], at[1], at[2]}, normalised(Quat{at[3], at[4], at[5], at[6]})}
			next := compose(pose, exp6(Vec{by[0], by[1], by[2]}, Vec{by[3], by[4], by[5]}))
			copy(to, next.Xyz[:])
			unit := normalised(next.Quaternion)
			copy(to[3:], unit[:])
		case "planar":
			length := math.Hypot(at[2], at[3])
			c, s := at[2]/length, at[3]/length
			x := sinc(by[2])*by[0] - by[2]*cosc(by[2])*by[1]
			y := by[2]*cosc(by[2])*by[0] + sinc(by[2])*by[1]
			to[0] = at[0] + c*x - s*y
			to[1] = at[1] + s*x + c*y
			turned(to[2:], at[2:], by[2])
		}
	}
	return moved
}

// turned is (cos, sin), at length one and turned by an angle.
func turned(to, at []float64, angle float64) {
	length := math.Hypot(at[0], at[1])
	c, s := at[0]/length, at[1]/length
	to[0] = c*math.Cos(angle) - s*math.Sin(angle)
	to[1] = s*math.Cos(angle) + c*math.Sin(angle)
}

// difference is target (-) q of the actuated joints.
func difference(mechanism Mechanism, target, q []float64) []float64 {
	o := order(mechanism)
	found := make([]float64, o.n_a)
	for _, body := range mechanism.Bodies {
		if body.Mimic != nil || !body.Actuated || body.Joint == "fixed" {
			continue
		}
		a, b, d := target[o.q[body.Name]:], q[o.q[body.Name]:], found[o.v[body.Name]:]
		switch body.Joint {
		case "revolute", "prismatic":
			d[0] = a[0] - b[0]
		case "continuous":
			d[0] = angle(a, b)
		case "floating":
			inverse := conjugate(normalised(Quat{b[3], b[4], b[5], b[6]}))
			shift := rotate(inverse, Vec{a[0] - b[0], a[1] - b[1], a[2] - b[2]})
			v, w := log6(Pose{shift, product(inverse, normalised(Quat{a[3], a[4], a[5], a[6]}))})
			copy(d, v[:])
			copy(d[3:], w[:])
		case "planar":
			w := angle(a[2:], b[2:])
			length := math.Hypot(b[2], b[3])
			c, s := b[2]/length, b[3]/length
			x := c*(a[0]-b[0]) + s*(a[1]-b[1])
			y := c*(a[1]-b[1]) - s*(a[0]-b[0])
			straight := 1 - w*w*cotangent(w)
			d[0] = straight*x + w/2*y
			d[1] = straight*y - w/2*x
			d[2] = w
		}
	}
	return found
}

// angle is that from (cos, sin) b to a.
func angle(a, b []float64) float64 {
	return math.Atan2(a[1]*b[0]-a[0]*b[1], a[0]*b[0]+a[1]*b[1])
}
