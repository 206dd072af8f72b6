package main

import (
	"fmt"
	"math"
	"sort"
)

// Touch is what a step says of a contact.
type Touch struct {
	Pair  string       `json:"pair"`
	Index int          `json:"index"`
	Phi   float64      `json:"phi"`
	Alpha Vec          `json:"alpha"`
	Beta  Vec          `json:"beta"`
	N     Vec          `json:"n"`
	D1    Vec          `json:"d1"`
	D2    Vec          `json:"d2"`
	J     [4][]float64 `json:"J"`
}

type Contact struct {
	Touch
	Alpha_body, Beta_body *string
	Mu_v, Mu_omega        float64
	Rows                  int
	Lam                   []float64
}

// tangents are d1, the world axis with the least |n_i| less its part along n, and d2 = n x d1.
func tangents(n Vec) (d1, d2 Vec) {
	least := 0
	for i := 1; i < 3; i++ {
		if math.Abs(n[i]) < math.Abs(n[least]) {
			least = i
		}
	}
	d1 = unit(along(axis(least), n, -n[least]))
	return d1, cross(n, d1)
}

// selection is the places of the k least, those of equal phi in ascending order.
func selection(phi []float64, normals []Vec, k int) []int {
	places := []int{}
	for i := range phi {
		if normals == nil || dot(normals[i], normals[len(normals)-1]) >= math.Cos(0.25) {
			places = append(places, i)
		}
	}
	sort.SliceStable(places, func(a, b int) bool { return phi[places[a]] < phi[places[b]] })
	if len(places) > k {
		places = places[:k]
	}
	for extra := len(phi); normals != nil && len(places) < k && len(places) < len(phi); extra++ {
		places = append(places, extra)
	}
	return places
}

// jacobian is that of beta less alpha, in the world, and of the relative turn about n.
func jacobian(c Contact, found map[string]Frame, n_v int) (J [4][]float64) {
	for i := range J {
		J[i] = make([]float64, n_v)
	}
	count := func(sign float64, body *string, x Vec) {
		if body == nil {
			return
		}
		linear, angular := velocities(found[*body], x, n_v)
		for j := range linear {
			for i := 0; i < 3; i++ {
				J[i][j] += sign * linear[j][i]
			}
			J[3][j] += sign * dot(c.N, angular[j])
		}
	}
	count(1, c.Beta_body, c.Beta)
	count(-1, c.Alpha_body, c.Alpha)
	return
}

// cone is the rows t of a contact; t_3 is 0 without torsion.
func cone(name string, rows int) (t []Vec) {
	star := []Vec{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}
	spins := []Vec{{0, 0, 1}, {0, 0, -1}}
	facets := 0
	switch {
	case name == "frictionless":
		return []Vec{{}}
	case name == "product" && rows == 6:
		for _, spin := range spins {
			for _, s := range star {
				t = append(t, add(s, spin))
			}
		}
		return
	case name == "pyramid" || name == "product":
		t = star
	default:
		fmt.Sscanf(name, "facets-%d", &facets)
		for k := 0; k < facets; k++ {
			angle := 2 * math.Pi * float64(k) / float64(facets)
			t = append(t, Vec{math.Cos(angle), math.Sin(angle), 0})
		}
	}
	if rows == 6 {
		t = append(t, spins...)
	}
	return
}

// frictionRows are the rows (n~ + d~_i)' J of all contacts, and b = -phi.
func frictionRows(name string, contacts []Contact) (A [][]float64, b []float64) {
	A, b = [][]float64{}, []float64{}
	for _, c := range contacts {
		for _, t := range cone(name, c.Rows) {
			d := add(scale(c.Mu_v*t[0], c.D1), scale(c.Mu_v*t[1], c.D2))
			row := make([]float64, len(c.J[0]))
			for j := range row {
				row[j] = dot(add(c.N, d), Vec{c.J[0][j], c.J[1][j], c.J[2][j]}) + c.Mu_omega*t[2]*c.J[3][j]
			}
			A, b = append(A, row), append(b, -c.Phi)
		}
	}
	return
}

// wrench is (f_d1, f_d2, f_n, tau_n) of a contact.
func wrench(name string, c Contact, h float64) [4]float64 {
	if name == "ellipsoid" {
		return [4]float64{c.Lam[1] / h, c.Lam[2] / h, c.Lam[0] / h, c.Lam[3] / h}
	}
	sum := 0.0
	slip := Vec{}
	for i, t := range cone(name, c.Rows) {
		sum += c.Lam[i]
		slip = along(slip, t, c.Lam[i])
	}
	return [4]float64{c.Mu_v * slip[0] / h, c.Mu_v * slip[1] / h, sum / h, c.Mu_omega * slip[2] / h}
}

// net is the force on each body, and the torque about its point.
func net(contacts []Contact, wrenches [][4]float64, points map[string]Vec) map[string][6]float64 {
	total := map[string][6]float64{}
	for body := range points {
		total[body] = [6]float64{}
	}
	for j, c := range contacts {
		w := wrenches[j]
		force := add(add(scale(w[0], c.D1), scale(w[1], c.D2)), scale(w[2], c.N))
		count := func(sign float64, body *string, x Vec) {
			if body == nil {
				return
			}
			point, known := points[*body]
			if !known {
				return
			}
			torque := add(cross(sub(x, point), force), scale(w[3], c.N))
			sum := total[*body]
			for i := 0; i < 3; i++ {
				sum[i] += sign * force[i]
				sum[3+i] += sign * torque[i]
			}
			total[*body] = sum
		}
		count(1, c.Beta_body, c.Beta)
		count(-1, c.Alpha_body, c.Alpha)
	}
	return total
}
