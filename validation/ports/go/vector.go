package main

import "math"

type Vec [3]float64

func add(a, b Vec) Vec              { return Vec{a[0] + b[0], a[1] + b[1], a[2] + b[2]} }
func sub(a, b Vec) Vec              { return Vec{a[0] - b[0], a[1] - b[1], a[2] - b[2]} }
func scale(s float64, a Vec) Vec    { return Vec{s * a[0], s * a[1], s * a[2]} }
func dot(a, b Vec) float64          { return a[0]*b[0] + a[1]*b[1] + a[2]*b[2] }
func norm(a Vec) float64            { return math.Sqrt(dot(a, a)) }
func unit(a Vec) Vec                { return scale(1/norm(a), a) }
func axis(i int) (e Vec)            { e[i] = 1; return }
func along(p, u Vec, t float64) Vec { return add(p, scale(t, u)) }

func cross(a, b Vec) Vec {
	return Vec{a[1]*b[2] - a[2]*b[1], a[2]*b[0] - a[0]*b[2], a[0]*b[1] - a[1]*b[0]}
}

// Quat is [x y z w].
type Quat [4]float64

func vector(q Quat) Vec     { return Vec{q[0], q[1], q[2]} }
func conjugate(q Quat) Quat { return Quat{-q[0], -q[1], -q[2], q[3]} }

func normalised(q Quat) Quat {
	length := math.Sqrt(q[0]*q[0] + q[1]*q[1] + q[2]*q[2] + q[3]*q[3])
	return Quat{q[0] / length, q[1] / length, q[2] / length, q[3] / length}
}

func product(a, b Quat) Quat {
	u, v := vector(a), vector(b)
	w := add(add(scale(a[3], v), scale(b[3], u)), cross(u, v))
	return Quat{w[0], w[1], w[2], a[3]*b[3] - dot(u, v)}
}

func rotate(q Quat, x Vec) Vec {
	u := vector(q)
	t := scale(2, cross(u, x))
	return add(add(x, scale(q[3], t)), cross(u, t))
}

// turn is the rotation by an angle about a unit vector.
func turn(about Vec, angle float64) Quat {
	s := math.Sin(angle / 2)
	return Quat{s * about[0], s * about[1], s * about[2], math.Cos(angle / 2)}
}

type Pose struct {
	Xyz        Vec
	Quaternion Quat
}

func place(pose Pose, x Vec) Vec { return add(pose.Xyz, rotate(pose.Quaternion, x)) }

func compose(a, b Pose) Pose {
	return Pose{place(a, b.Xyz), product(a.Quaternion, normalised(b.Quaternion))}
}

// sinc is sin t / t.
func sinc(t float64) float64 {
	if t == 0 {
		return 1
	}
	return math.Sin(t) / t
}

// cosc is (1 - cos t) / t^2.
func cosc(t float64) float64 { return sinc(t/2) * sinc(t/2) / 2 }

// cubic is (t - sin t) / t^3.
func cubic(t float64) float64 {
	if math.Abs(t) > 0.3 {
		return (t - math.Sin(t)) / (t * t * t)
	}
	term, sum := 1.0/6, 0.0
	for k := 4.0; k < 20; k += 2 {
		sum += term
		term *= -t * t / (k * (k + 1))
	}
	return sum
}

// exp6 is the motion of the twist (v, w), a screw.
func exp6(v, w Vec) Pose {
	t := norm(w)
	once := cross(w, v)
	shift := add(v, add(scale(cosc(t), once), scale(cubic(t), cross(w, once))))
	half := scale(sinc(t/2)/2, w)
	return Pose{shift, Quat{half[0], half[1], half[2], math.Cos(t / 2)}}
}

// log6 is the least twist whose motion is the pose.
func log6(pose Pose) (v, w Vec) {
	q := pose.Quaternion
	if q[3] < 0 {
		q = Quat{-q[0], -q[1], -q[2], -q[3]}
	}
	s := norm(vector(q))
	t := 2 * math.Atan2(s, q[3])
	w = scale(2/q[3], vector(q))
	if s > 0 {
		w = scale(t/s, vector(q))
	}
	once := cross(w, pose.Xyz)
	v = add(sub(pose.Xyz, scale(0.5, once)), scale(cotangent(t), cross(w, once)))
	return
}

// cotangent is (1 - t/2 cot(t/2)) / t^2.
func cotangent(t float64) float64 {
	if math.Abs(t) > 0.3 {
		return (1 - t/2/math.Tan(t/2)) / (t * t)
	}
	s := t * t
	return 1.0/12 + s*(1.0/720+s*(1.0/30240+s*(1.0/1209600+s*(1.0/47900160+s*691/1307674368000))))
}
