package main

import "math/big"

// Numbers of the quadratic program have 400 bits: what differs by one unit in the last place of a float64 differs.
type Number = *big.Float

func number(x float64) Number  { return new(big.Float).SetPrec(400).SetFloat64(x) }
func plus(a, b Number) Number  { return number(0).Add(a, b) }
func minus(a, b Number) Number { return number(0).Sub(a, b) }
func times(a, b Number) Number { return number(0).Mul(a, b) }
func over(a, b Number) Number  { return number(0).Quo(a, b) }
func float(a Number) float64   { x, _ := a.Float64(); return x + 0 }
func less(a, b Number) bool    { return a.Cmp(b) < 0 }
func tiny(a, size Number) bool { return !less(times(size, number(1e-60)), a) }

func numbers(x []float64) (found []Number) {
	for _, value := range x {
		found = append(found, number(value))
	}
	return
}

func floats(x []Number) []float64 {
	found := make([]float64, len(x))
	for i := range x {
		found[i] = float(x[i])
	}
	return found
}

func inner(a, b []Number) Number {
	sum := number(0)
	for i := range a {
		if a[i].Sign() != 0 && b[i].Sign() != 0 {
			sum.Add(sum, times(a[i], b[i]))
		}
	}
	return sum
}

// Factors are Cholesky's L D L' of a symmetric positive definite matrix.
type Factors struct {
	L [][]Number
	D []Number
}

func factors(matrix [][]Number) Factors {
	n := len(matrix)
	L, D := make([][]Number, n), make([]Number, n)
	for i := range L {
		L[i] = make([]Number, n)
		for j := 0; j <= i; j++ {
			sum := matrix[i][j]
			for k := 0; k < j; k++ {
				sum = minus(sum, times(times(L[i][k], L[j][k]), D[k]))
			}
			if i == j {
				D[i] = sum
			} else {
				L[i][j] = over(sum, D[j])
			}
		}
	}
	return Factors{L, D}
}

func (f Factors) solve(right []Number) []Number {
	x := append([]Number{}, right...)
	for i := range x {
		for k := 0; k < i; k++ {
			x[i] = minus(x[i], times(f.L[i][k], x[k]))
		}
	}
	for i := len(x) - 1; i >= 0; i-- {
		x[i] = over(x[i], f.D[i])
		for k := i + 1; k < len(x); k++ {
			x[i] = minus(x[i], times(f.L[k][i], x[k]))
		}
	}
	return x
}

// multipliers are lam >= 0 with S lam + s >= 0 and lam'(S lam + s) = 0: the dual method of Goldfarb and Idnani
// in the rows alone, S = A H^-1 A' and s the slacks without contacts. Or Farkas' vector.
func multipliers(S [][]Number, s []Number) (lam []Number, farkas []float64) {
	size := number(0)
	for i := range s {
		lam = append(lam, number(0))
		if a := number(0).Abs(s[i]); less(size, a) {
			size = a
		}
	}
	working := []int{}
	for {
		p := -1
		worst := number(0)
		for i := range s {
			slack := plus(inner(S[i], lam), s[i])
			if less(slack, worst) {
				p, worst = i, slack
			}
		}
		if p < 0 || tiny(number(0).Neg(worst), size) {
			return lam, nil
		}
		for added := false; !added; {
			matrix, right := make([][]Number, len(working)), make([]Number, len(working))
			for a, i := range working {
				for _, j := range working {
					matrix[a] = append(matrix[a], S[i][j])
				}
				right[a] = S[i][p]
			}
			r := factors(matrix).solve(right)
			for a := range r {
				if tiny(number(0).Abs(r[a]), number(1)) {
					r[a] = number(0)
				}
			}
			curvature := minus(S[p][p], inner(right, r))
			leaving := -1
			var length Number
			for a, i := range working {
				if r[a].Sign() > 0 {
					if ratio := over(lam[i], r[a]); leaving < 0 || less(ratio, length) {
						leaving, length = a, ratio
					}
				}
			}
			if tiny(curvature, S[p][p]) {
				if leaving < 0 {
					return nil, certificate(len(s), p, working, r)
				}
			} else {
				slack := plus(inner(S[p], lam), s[p])
				full := over(number(0).Neg(slack), curvature)
				if leaving < 0 || !less(length, full) {
					length, added = full, true
				}
			}
			for a, i := range working {
				lam[i] = minus(lam[i], times(length, r[a]))
			}
			lam[p] = plus(lam[p], length)
			if added {
				working = append(working, p)
			} else {
				lam[working[leaving]] = number(0)
				working = append(working[:leaving], working[leaving+1:]...)
			}
		}
	}
}

// certificate is y >= 0 with A'y = 0 and b'y > 0, its largest entry 1.
func certificate(count, p int, working []int, r []Number) []float64 {
	y := make([]Number, count)
	for i := range y {
		y[i] = number(0)
	}
	y[p] = number(1)
	largest := y[p]
	for a, i := range working {
		y[i] = number(0).Neg(r[a])
		if less(largest, y[i]) {
			largest = y[i]
		}
	}
	for i := range y {
		y[i] = over(y[i], largest)
	}
	return floats(y)
}

type Program struct {
	H       [][]float64
	G       []float64
	A       [][]float64
	B       []float64
	S       [][]Number
	s       []Number
	rows    [][]Number
	free    []Number
	hessian Factors
}

// prepare makes S = A H^-1 A' and s = A H^-1 g - b.
func (p *Program) prepare() {
	var H, columns [][]Number
	for i := range p.H {
		H = append(H, numbers(p.H[i]))
	}
	p.hessian = factors(H)
	p.free = p.hessian.solve(numbers(p.G))
	for i := range p.A {
		row := numbers(p.A[i])
		p.rows = append(p.rows, row)
		columns = append(columns, p.hessian.solve(row))
		p.s = append(p.s, minus(inner(row, p.free), number(p.B[i])))
	}
	for i := range p.rows {
		var line []Number
		for j := range p.rows {
			if j < i {
				line = append(line, p.S[j][i])
			} else {
				line = append(line, inner(p.rows[i], columns[j]))
			}
		}
		p.S = append(p.S, line)
	}
}

// optimum is the answer of the layer qp.
func (p *Program) optimum() map[string]any {
	p.prepare()
	lam, farkas := multipliers(p.S, p.s)
	if farkas != nil {
		return map[string]any{"farkas": farkas}
	}
	n := len(p.G)
	impulse := make([]Number, n)
	total := numbers(p.G)
	for j := 0; j < n; j++ {
		impulse[j] = number(0)
		for i := range p.rows {
			impulse[j] = plus(impulse[j], times(p.rows[i][j], lam[i]))
		}
		total[j] = plus(total[j], impulse[j])
	}
	x := p.hessian.solve(total)
	slack := make([]Number, len(p.rows))
	for i := range p.rows {
		slack[i] = minus(inner(p.rows[i], x), number(p.B[i]))
	}
	return map[string]any{"delta_q": floats(x), "lam": floats(lam), "A_lam": floats(impulse), "slack": floats(slack)}
}
