// Twenty steps of a scene, asked for in lines of JSON: go run client.go SCENE
package main

import (
	"bufio"
	"encoding/json"
	"fmt"
	"log"
	"os"
	"os/exec"
)

type scene struct {
	QStart []float64 `json:"q_start"`
	NQA    int       `json:"n_q_a"`
}

type request struct {
	Q      []float64 `json:"q"`
	Target []float64 `json:"target"`
	Ask    []string  `json:"ask"`
}

type answer struct {
	Q           []float64 `json:"q"`
	Certificate string    `json:"certificate"`
	Error       string    `json:"error"`
}

func read(lines *bufio.Reader, value any) {
	line, err := lines.ReadBytes('\n')
	if err == nil {
		err = json.Unmarshal(line, value)
	}
	if err != nil {
		log.Fatal(err)
	}
}

func main() {
	name := os.Args[1]
	command := os.Getenv("QUASISTATIC_REF")
	if command == "" {
		command = "quasistatic-ref"
	}
	server := exec.Command(command, "serve", name)
	in, _ := server.StdinPipe()
	out, _ := server.StdoutPipe()
	if err := server.Start(); err != nil {
		log.Fatal(err)
	}
	lines, requests := bufio.NewReader(out), json.NewEncoder(in)
	var first struct{ Scenes map[string]scene }
	read(lines, &first)
	known := first.Scenes[name]
	q := known.QStart
	for step := 0; step < 20; step++ {
		requests.Encode(request{q, q[:known.NQA], []string{"q", "certificate"}})
		var found answer
		read(lines, &found)
		if found.Error != "" {
			log.Fatal(found.Error)
		}
		q = found.Q
	}
	text, _ := json.Marshal(q)
	fmt.Println(string(text))
	in.Close()
	server.Wait()
}
