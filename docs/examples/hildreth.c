#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The numbers behind a key, row after row. */
static double *numbers(const char *text, const char *key, int *count) {
    const char *p = strchr(strstr(text, key), '[');
    double *v = malloc(sizeof(double) * (strlen(p) / 2 + 1));
    int depth = 0;
    *count = 0;
    do {
        char *end = (char *)p + 1;
        if (*p == '[') depth++;
        else if (*p == ']') depth--;
        else if (*p != ',' && *p != ' ') v[(*count)++] = strtod(p, &end);
        p = end;
    } while (depth);
    return v;
}

/* x := H^-1 x, by H = L L' with L in the lower triangle. */
static void solve(const double *L, double *x, int n) {
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++) x[i] -= L[i * n + k] * x[k];
        x[i] /= L[i * n + i];
    }
    for (int i = n; i-- > 0; x[i] /= L[i * n + i])
        for (int k = i + 1; k < n; k++) x[i] -= L[k * n + i] * x[k];
}

/* Hildreth's method: one multiplier after the other, until none changes x any more. */
static void answer(const char *text) {
    int n, m, nn, mn, done = 0;
    double *L = numbers(text, "\"H\"", &nn), *x = numbers(text, "\"g\"", &n);
    double *A = numbers(text, "\"A\"", &mn), *b = numbers(text, "\"b\"", &m);
    double *W = malloc(sizeof(double) * (mn + 1)), *lam = calloc(m + 1, sizeof(double));
    for (int j = 0; j < n; j++)
        for (int i = j; i < n; i++) {
            for (int k = 0; k < j; k++) L[i * n + j] -= L[i * n + k] * L[j * n + k];
            L[i * n + j] = i == j ? sqrt(L[i * n + j]) : L[i * n + j] / L[j * n + j];
        }
    solve(L, x, n);                                      /* x = H^-1 g */
    memcpy(W, A, sizeof(double) * mn);
    for (int i = 0; i < m; i++) solve(L, W + i * n, n);  /* rows of A H^-1 */
    for (int sweep = 0; sweep < 20000 && !done; sweep++) {
        double change = 0, length = 0;
        for (int i = 0; i < m; i++) {
            double slack = -b[i], square = 0;
            for (int k = 0; k < n; k++) {
                slack += A[i * n + k] * x[k];
                square += A[i * n + k] * W[i * n + k];
            }
            double step = fmax(-slack / square, -lam[i]);
            lam[i] += step;
            for (int k = 0; k < n; k++) x[k] += step * W[i * n + k];
            change += step * step * square;
        }
        for (int k = 0; k < n; k++) length += x[k] * x[k];
        done = change <= 1e-26 * (1 + length);
    }
    printf("{\"status\": \"%s\", \"delta_q\": [", done ? "optimal" : "too many sweeps");
    for (int k = 0; k < n; k++) printf("%s%.17g", k ? ", " : "", x[k]);
    printf("], \"lam\": [");
    for (int i = 0; i < m; i++) printf("%s%.17g", i ? ", " : "", lam[i]);
    printf("]}\n");
    fflush(stdout);
    free(L); free(x); free(A); free(b); free(W); free(lam);
}

/* A line for each problem. */
int main(void) {
    char *line = NULL;
    size_t capacity = 0;
    while (getline(&line, &capacity, stdin) > 0) answer(line);
    return 0;
}
