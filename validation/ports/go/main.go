// The quasi-dynamic model, from the README of the vectors alone: layers 1 to 8 in polyhedral cones.
//
//	port VECTORS ANSWERS    writes ANSWERS/LAYER.json for each layer
//	port                    answers the cases of a challenge, one a line
package main

import (
	"bufio"
	"encoding/json"
	"fmt"
	"os"
	"path/filepath"
)

type Case struct {
	Id    string          `json:"id"`
	Layer string          `json:"layer"`
	Input json.RawMessage `json:"input"`
}

var layers = []string{"distance", "selection", "jacobian", "rows", "qp", "wrench", "integrate", "step"}

var shapes map[string]Shape // those that the cases of a file share

func named(shape Shape) Shape {
	if shape.Kind == "shared" {
		return shapes[shape.Name]
	}
	return shape
}

func read(text []byte, into any) {
	if err := json.Unmarshal(text, into); err != nil {
		panic(err)
	}
}

func answer(layer string, input []byte) any {
	switch layer {
	case "distance":
		var in struct {
			Alpha, Beta           Shape
			Pose_alpha, Pose_beta Pose
		}
		read(input, &in)
		identity := Pose{Quaternion: Quat{0, 0, 0, 1}}
		at, bt := compose(identity, in.Pose_alpha), compose(identity, in.Pose_beta)
		alpha, beta := named(in.Alpha), named(in.Beta)
		if alpha.Kind != "cloud" && beta.Kind != "cloud" {
			return distance(alpha, beta, at, bt)
		}
		found := distances(alpha, beta, at, bt)
		phi, first, second, n := []float64{}, []Vec{}, []Vec{}, []Vec{}
		for _, d := range found {
			phi, first, second, n = append(phi, d.Phi), append(first, d.Alpha), append(second, d.Beta), append(n, d.N)
		}
		return map[string]any{"phi": phi, "alpha": first, "beta": second, "n": n}
	case "selection":
		var in struct {
			Phi     [][]float64
			Normals [][]Vec
			K       int
		}
		read(input, &in)
		indices := [][]int{}
		for i, phi := range in.Phi {
			var normals []Vec
			if in.Normals != nil {
				normals = in.Normals[i]
			}
			indices = append(indices, selection(phi, normals, in.K))
		}
		return map[string]any{"indices": indices}
	case "jacobian":
		var in struct {
			Mechanism Mechanism
			Q         []float64
			Contacts  []Contact
		}
		read(input, &in)
		found := frames(in.Mechanism, in.Q)
		J := [][4][]float64{}
		for _, c := range in.Contacts {
			J = append(J, jacobian(c, found, order(in.Mechanism).n_v))
		}
		return map[string]any{"J": J}
	case "rows":
		var in struct {
			Cone     string
			Contacts []Contact
		}
		read(input, &in)
		A, b := frictionRows(in.Cone, in.Contacts)
		return map[string]any{"A": A, "b": b}
	case "qp":
		var in Program
		read(input, &in)
		return in.optimum()
	case "wrench":
		var in struct {
			H        float64
			Cone     string
			Contacts []Contact
			Bodies   map[string]struct{ Point Vec }
		}
		read(input, &in)
		wrenches, points := [][4]float64{}, map[string]Vec{}
		for _, c := range in.Contacts {
			wrenches = append(wrenches, wrench(in.Cone, c, in.H))
		}
		for body, value := range in.Bodies {
			points[body] = value.Point
		}
		return map[string]any{"wrench": wrenches, "net": net(in.Contacts, wrenches, points)}
	case "integrate":
		var in struct {
			Mechanism  Mechanism
			Q, Delta_q []float64
		}
		read(input, &in)
		return map[string]any{"q": integrated(in.Mechanism, in.Q, in.Delta_q)}
	case "step":
		var in Scene
		read(input, &in)
		for name, shape := range in.Shapes {
			shape.Shape = named(shape.Shape)
			in.Shapes[name] = shape
		}
		return step(in)
	}
	return nil
}

// Kinds of shapes that distance has a closed form for, in either order, and cones that rows has.
var pairs = map[[2]string]bool{}
var cones = map[string]bool{"pyramid": true, "product": true, "frictionless": true,
	"facets-4": true, "facets-6": true, "facets-8": true, "facets-16": true}

func init() {
	polytopes := []string{"sphere", "box", "capsule", "convex", "cloud"}
	for i, one := range polytopes {
		for _, other := range polytopes[i:] {
			pairs[[2]string{one, other}] = one != "cloud"
		}
		pairs[[2]string{"halfspace", one}] = true
	}
	for _, one := range []string{"sphere", "cloud", "halfspace"} {
		pairs[[2]string{"cylinder", one}] = true
	}
}

func supported(layer string, input []byte) bool {
	var asked struct {
		Second_order any
		Cone         string
	}
	read(input, &asked)
	if asked.Second_order != nil || asked.Cone != "" && !cones[asked.Cone] {
		return false
	}
	kinds := [][2]string{}
	switch layer {
	case "distance":
		var in struct{ Alpha, Beta Shape }
		read(input, &in)
		kinds = append(kinds, [2]string{named(in.Alpha).Kind, named(in.Beta).Kind})
	case "step":
		var in Scene
		read(input, &in)
		for _, pair := range in.Pairs {
			alpha, beta := in.Shapes[pair.Alpha].Shape, in.Shapes[pair.Beta].Shape
			one, other := named(alpha).Kind, named(beta).Kind
			kinds = append(kinds, [2]string{one, other})
			// Outlines of a mesh's faces are not known here.
			if pair.K > 1 && (one == "convex" || other == "convex") && one != "cloud" && other != "cloud" {
				return false
			}
		}
	}
	for _, pair := range kinds {
		if !pairs[pair] && !pairs[[2]string{pair[1], pair[0]}] {
			return false
		}
	}
	return true
}

// answered is one case's line: its output, that it is not supported, or why there is none.
func answered(c Case) (line map[string]any) {
	line = map[string]any{"id": c.Id}
	defer func() {
		if reason := recover(); reason != nil {
			line["error"] = fmt.Sprint(reason)
		}
	}()
	output := any(nil)
	if supported(c.Layer, c.Input) {
		output = answer(c.Layer, c.Input)
	}
	if output == nil {
		line["unsupported"] = true
		return
	}
	text, err := json.Marshal(output)
	if err != nil {
		panic(err)
	}
	line["output"] = json.RawMessage(text)
	return
}

func main() {
	if len(os.Args) > 2 {
		for _, layer := range layers {
			var file struct {
				Cases  []Case
				Shapes map[string]Shape
			}
			text, err := os.ReadFile(filepath.Join(os.Args[1], "inputs", layer+".json"))
			if err != nil {
				panic(err)
			}
			read(text, &file)
			shapes = file.Shapes
			answers := []any{}
			for _, c := range file.Cases {
				c.Layer = layer
				line := answered(c)
				if line["error"] == nil {
					answers = append(answers, line)
				}
			}
			text, _ = json.Marshal(map[string]any{"format": "quasistatic-ref/vectors-answers", "version": 1, "layer": layer,
				"implementation": "the port in Go", "tangent": "body", "quaternion": "xyzw", "answers": answers})
			if err := os.WriteFile(filepath.Join(os.Args[2], layer+".json"), text, 0o644); err != nil {
				panic(err)
			}
		}
		return
	}
	in, out := bufio.NewReader(os.Stdin), json.NewEncoder(os.Stdout)
	out.Encode(map[string]any{"protocol": 1, "implementation": "the port in Go", "layers": layers})
	for {
		text, err := in.ReadBytes('\n')
		if err != nil {
			return
		}
		var c Case
		read(text, &c)
		out.Encode(answered(c))
	}
}
