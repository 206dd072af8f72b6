/* Twenty steps of one free body that no motor moves, in binary form: ./client SCENE.
   A scene's own numbers (7 of q, none of the target, 6 of the force) stand in the first line. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { N_Q = 7, N_V = 6, ERROR = 4 };

int main(int count, char **words) {
  int in[2], out[2];
  if (count < 2 || pipe(in) || pipe(out)) return 2;
  if (fork() == 0) { /* the server, its standard input and output at our pipes */
    dup2(in[0], 0);
    dup2(out[1], 1);
    close(in[1]);
    close(out[0]);
    const char *command = getenv("QUASISTATIC_REF");
    execlp(command ? command : "quasistatic-ref", "quasistatic-ref", "serve", "--binary", words[1],
           (char *)0);
    return 127;
  }
  close(in[0]);
  close(out[1]);
  FILE *to = fdopen(in[1], "wb"), *from = fdopen(out[0], "rb");
  while (fgetc(from) != '\n' && !feof(from)) { /* the first line */
  }
  double numbers[N_Q + N_V] = {0, 0, atof(count > 2 ? words[2] : "0.05"), 0, 0, 0, 1};
  numbers[N_Q + 5] = 0.02; /* a torque about its z axis [N m] */
  for (int step = 0; step < 20; step++) {
    uint32_t request[2] = {0, 0}, answer[2]; /* the first scene, without forces; kind and bytes */
    fwrite(request, sizeof request, 1, to);
    fwrite(numbers, sizeof numbers, 1, to);
    fflush(to);
    if (fread(answer, sizeof answer, 1, from) != 1) return 3;
    if (answer[0] == ERROR) {
      while (answer[1]--) fputc(fgetc(from), stderr);
      return 3;
    }
    if (fread(numbers, sizeof(double), N_Q, from) != N_Q) return 3;
  }
  for (int i = 0; i < N_Q; i++) printf("%.17g\n", numbers[i]);
  return 0;
}
