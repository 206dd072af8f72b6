"""Twenty steps of a scene, asked for in lines of JSON: ``python client.py SCENE``."""

import json
import subprocess
import sys

command = [sys.executable, "-m", "quasistatic_ref", "serve", sys.argv[1]]
server = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
(scene,) = json.loads(server.stdout.readline())["scenes"].values()
q = scene["q_start"]
for _ in range(20):
    request = {"q": q, "target": q[: scene["n_q_a"]], "ask": ["q", "certificate"]}
    print(json.dumps(request), file=server.stdin, flush=True)
    answer = json.loads(server.stdout.readline())
    if "error" in answer:
        sys.exit(answer["error"])
    q = answer["q"]
print(json.dumps(q))
server.stdin.close()
server.wait()
