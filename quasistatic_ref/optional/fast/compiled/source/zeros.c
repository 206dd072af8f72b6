/* Zeros of the optimum on a working set, and what the rows without slack mean, decided without
   rounding: docs/proofs.md.

   K z = f is solved modulo powers of p = 2^56 - 5. The digits of z to the base p, the last first, are
   d = K^-1 r mod p, where r is f at first, and (r - K d) / p from then on. */

#include <math.h>
#include <stdlib.h>

#include "proof.h"

#define P (((uint64_t)1 << BITS) - 5)
#define FIFTH 0xCCCCCCCCCCCCCDu /* 5 FIFTH = 1 modulo 2^56 */

enum { SUMS = 12 }; /* that are tried */

typedef unsigned __int128 Wide;

typedef struct {
    const Proof *s;
    const Room *m;
    int64_t N, others; /* unknowns; rows outside of the working set */
    uint64_t *LU, *d;  /* factors of K modulo p; one digit of each unknown, behind what is solved for */
    int64_t *order, *weight, *sign; /* of the rows of K in LU; of the other rows */
    Float *digit;
    Number *r, *A, *b; /* residuals, those of the other rows too; the other rows and their b */
} Lifting;

static uint64_t modulo(Wide x)
{
    x = (x >> BITS) * 5 + (x & (P + 4));
    x = (x >> BITS) * 5 + (x & (P + 4));
    return (uint64_t)(x >= P ? x - P : x);
}

/* 2^896 x modulo p, where 2^56 is 5. */
static uint64_t residue(const Number *x)
{
    __int128 sum = 0;
    for (int j = x->high - 1; j >= 0; j--)
        sum = sum * 5 + (j < x->low ? 0 : x->d[j]);
    return sum < 0 ? P - modulo((Wide)-sum) : modulo((Wide)sum);
}

/* 1 / x modulo p: x^(p - 2). */
static uint64_t reciprocal(uint64_t x)
{
    uint64_t power = 1;
    for (int bit = BITS - 1; bit >= 0; bit--) {
        power = modulo((Wide)power * power);
        if ((P - 2) >> bit & 1)
            power = modulo((Wide)power * x);
    }
    return power;
}

/* The entry of K in a row and a column. */
static void entry(const Lifting *l, int64_t i, int64_t j, Number *x)
{
    int64_t n = l->s->n_v;
    const Number *H = l->s->hessian, *A = l->m->A;
    if (i >= n)
        *x = A[(i - n) * n + j];
    else if (j < n)
        *x = H[i * n + j];
    else
        product(A + (j - n) * n + i, exact(-1.0), x);
}

/* K = LU modulo p, rows exchanged, with -L and the reciprocal pivots in place; 0 if it is singular. */
static int factored(Lifting *l)
{
    int64_t N = l->N;
    for (int64_t i = 0; i < N; i++) {
        l->order[i] = i;
        for (int64_t j = 0; j < N; j++) {
            Number x;
            l->LU[i * N + j] = 0;
            if (l->m->K[i * N + j] == 0.0)
                continue;
            entry(l, i, j, &x);
            l->LU[i * N + j] = residue(&x);
        }
    }
    for (int64_t c = 0; c < N; c++) {
        int64_t p = c;
        while (p < N && !l->LU[p * N + c])
            p++;
        if (p == N)
            return 0;
        uint64_t *row = l->LU + c * N, *other = l->LU + p * N;
        for (int64_t j = 0; j < N && p != c; j++) {
            uint64_t x = row[j];
            row[j] = other[j];
            other[j] = x;
        }
        int64_t at = l->order[c];
        l->order[c] = l->order[p];
        l->order[p] = at;
        row[c] = reciprocal(row[c]);
        for (int64_t i = c + 1; i < N; i++) {
            other = l->LU + i * N;
            if (!other[c])
                continue;
            other[c] = P - modulo((Wide)other[c] * row[c]);
            for (int64_t j = c + 1; j < N; j++)
                if (row[j])
                    other[j] = modulo((Wide)other[c] * row[j] + other[j]);
        }
    }
    return 1;
}

/* The next digits: d = K^-1 r modulo p. */
static void digits(Lifting *l)
{
    int64_t N = l->N;
    uint64_t *d = l->d;
    for (int64_t i = 0; i < N; i++) {
        Wide sum = residue(l->r + l->order[i]);
        for (int64_t j = 0; j < i; j++)
            sum += (Wide)l->LU[i * N + j] * d[j];
        d[i] = modulo(sum);
    }
    for (int64_t i = N - 1; i >= 0; i--) {
        Wide sum = 0;
        for (int64_t j = i + 1; j < N; j++)
            sum += (Wide)l->LU[i * N + j] * d[j];
        d[i] = modulo((Wide)(d[i] + P - modulo(sum)) * l->LU[i * N + i]);
    }
    for (int64_t i = 0; i < N; i++)
        l->digit[i] = (Float){FRACTION, (int64_t)d[i], 0};
}

/* A sum divided by p, from its last digit on; the sum is empty then. 0 if p does not divide it. */
static int divided(Sum *sum, Number *x)
{
    __int128 carry = 0;
    int j = sum->low, last = 0;
    x->low = DIGITS;
    for (; j < DIGITS && (j < sum->high || carry); j++) {
        __int128 digit = sum->d[j] + carry;
        sum->d[j] = 0;
        int64_t q = (int64_t)((uint64_t)digit * -FIFTH << (64 - BITS)) >> (64 - BITS);
        carry = ((digit + 5 * (__int128)q) >> BITS) - q;
        x->d[j] = q;
        if (q) {
            x->low = x->low < j ? x->low : j;
            last = j + 1;
        }
    }
    sum->low = DIGITS;
    sum->high = 0;
    x->low = last ? x->low : 0;
    x->high = last;
    return carry == 0;
}

/* Of what power of two x is an odd multiple; x is not zero. */
static double grid(const Number *x)
{
    int j = x->low;
    while (!x->d[j])
        j++;
    return BITS * (j - FRACTION) + __builtin_ctzll((uint64_t)x->d[j]);
}

static double lower(double bound, const Number *x)
{
    return x->low == x->high ? bound : fmin(bound, grid(x));
}

/* Bits of a row (a, f) of whole numbers: a is a multiple of 2^of_a, f of 2^(of_a + of_f) with the
   least of_f so far. */
static double bits_of(double of_a, double squared, const Number *f, double *of_f)
{
    *of_f = fmin(*of_f, lower(of_a, f) - of_a);
    return log2(squared + value(f) * value(f)) / 2 - of_a;
}

/* Bits of the whole numbers of which z and the slacks are quotients: Hadamard's bound of
   determinants, each row and column as a multiple of a power of two. */
static double bits(const Lifting *l)
{
    const Proof *s = l->s;
    const Number *H = s->hessian, *A = l->m->A;
    int64_t n = s->n_v, k = s->working;
    double sum = 2.0, of_f = 0.0, most = 0.0, *of_H = l->m->rest;
    for (int64_t i = 0; i < l->N + l->others; i++) {
        const Number *row = i < n ? H + i * n : i < l->N ? A + (i - n) * n : l->A + (i - l->N) * n;
        double squared = 0.0, of_a = INFINITY;
        for (int64_t j = 0; j < n; j++) {
            squared += value(row + j) * value(row + j);
            of_a = lower(of_a, row + j);
        }
        for (int64_t w = 0; i < n && w < k; w++)
            squared += l->m->K[i * l->N + n + w] * l->m->K[i * l->N + n + w];
        of_a = of_a < INFINITY ? of_a : 0.0; /* of a row without entries */
        if (i < n)
            of_H[i] = of_a;
        double own = bits_of(of_a, squared, l->r + i, &of_f);
        if (i < l->N)
            sum += own;
        else
            most = fmax(most, own);
    }
    for (int64_t w = 0; w < k; w++) { /* the columns of y */
        double of_y = 0.0;
        for (int64_t i = 0; i < n; i++)
            of_y = fmin(of_y, lower(of_H[i], A + w * n + i) - of_H[i]);
        sum -= of_y;
    }
    return sum - of_f + most;
}

/* Whether some coordinates of the solution (all if NULL) and the slacks of the other rows are zero. */
static int vanish(Lifting *l, const int64_t *still, int64_t count)
{
    const Proof *s = l->s;
    int64_t n = s->n_v, N = l->N, rows = N + l->others;
    Sum sum = EMPTY;
    for (double left = bits(l); left >= 0.0; left -= BITS - 1) {
        digits(l);
        for (int64_t i = 0; i < count; i++)
            if (l->d[still ? still[i] : i])
                return 0;
        for (int64_t i = 0; i < rows; i++) {
            add(&sum, l->r + i);
            if (i < N)
                less(s, l->m, i, l->digit, &sum);
            for (int64_t v = 0; i >= N && v < n; v++)
                add_product(&sum, l->A + (i - N) * n + v, l->digit[v], -1);
            if (!divided(&sum, l->r + i))
                return 0;
        }
    }
    return !lost;
}

/* v with hH v - A_W'y = s and A_W v = 0, s being in r: which of the other rows v opens (1), closes
   (-1), or moves too little to be told (0); 0 if v is not found. */
static int moved(const Lifting *l, Room *m)
{
    int64_t n = l->s->n_v, N = l->N;
    memcpy(m->r, l->r, (size_t)N * sizeof(Number));
    memset(m->z, 0, (size_t)N * sizeof(Number));
    refined(l->s, m, REFINED);
    if (lost || !error_bounds(m->R, m->G, m->rest, N, m->e))
        return 0;
    for (int64_t i = 0; i < l->others; i++) {
        double along = 0.0, error = 0.0;
        for (int64_t v = 0; v < n; v++) {
            double a = value(l->A + i * n + v), x = value(m->z + v);
            along += a * x;
            error += fabs(a) * (m->e[v] + fabs(x) * 0x1p-40);
        }
        l->sign[i] = (along * DOWN > error * UP) - (-along * DOWN > error * UP);
    }
    return 1;
}

/* The residuals of A_W v = 0 and the weighted sum of the other rows. */
static void summed(Lifting *l, const int64_t *weight)
{
    int64_t n = l->s->n_v;
    Sum sum = EMPTY;
    memset(l->r, 0, (size_t)(l->N + l->others) * sizeof(Number));
    for (int64_t v = 0; v < n; v++) {
        for (int64_t i = 0; i < l->others; i++)
            add_product(&sum, l->A + i * n + v, exact((double)weight[i]), 1);
        carried(&sum, l->r + v);
    }
}

/* Whether all coordinates of the solution vanish, whatever the other rows do. */
static int spanned(Lifting *l)
{
    int64_t others = l->others;
    l->others = 0;
    int all = vanish(l, NULL, l->s->n_v);
    l->others = others;
    return all;
}

/* Keep the other rows whose sign is this one. */
static void only(Lifting *l, int64_t sign)
{
    int64_t n = l->s->n_v, kept = 0;
    for (int64_t i = 0; i < l->others; i++)
        if (l->sign[i] == sign) {
            memmove(l->A + kept * n, l->A + i * n, (size_t)n * sizeof(Number));
            l->weight[kept++] = 1;
        }
    l->others = kept;
}

/* Whether the sum of the other rows is spanned; if it is not, without the rows that are. */
static int all_active(Lifting *l)
{
    int64_t *weight = l->weight, count = l->others;
    for (int64_t i = 0; i < count; i++)
        weight[i] = 1;
    summed(l, weight);
    if (spanned(l))
        return 1;
    memset(weight, 0, (size_t)count * sizeof(int64_t));
    for (int64_t i = 0; i < count; i++) {
        weight[i] = 1;
        summed(l, weight);
        l->sign[i] = spanned(l);
        weight[i] = 0;
    }
    only(l, 0);
    return 0;
}

/* What E, the other rows, all without slack, mean: docs/proofs.md. Rows that v does not open count
   more in the next sum, by which v is found. */
static int claimed(Proof *s, Room *m, Lifting *l)
{
    int64_t closed = 1, left = 1;
    if (all_active(l))
        return DECIDED;
    s->claims[0] = s->counts[0] == l->others;
    for (int round = 0; round < SUMS && (closed || left); round++) {
        summed(l, l->weight);
        if (round && spanned(l)) {
            s->claims[0] = 0;
            return DECIDED;
        }
        summed(l, l->weight);
        if (!moved(l, m))
            return OPEN_CLAIM;
        closed = left = 0;
        for (int64_t i = 0; i < l->others; i++) {
            closed += l->sign[i] < 0;
            left += l->sign[i] == 0;
            l->weight[i] += l->sign[i] <= 0;
        }
    }
    s->claims[1] = 0;
    if (closed || !left)
        return closed ? OPEN_CLAIM : DECIDED;
    only(l, 0);
    s->claims[0] = 0;
    return vanish(l, NULL, 0) && all_active(l) ? DECIDED : OPEN_CLAIM;
}

/* The claims of the `others`, which do not follow from how the rows of contacts are combined. */
static int decided(Proof *s, Room *m, Lifting *l, const int64_t *others)
{
    int64_t n = s->n_v, N = l->N;
    for (int64_t i = 0; i < l->others; i++)
        row_of(s, others[i], l->A + i * n, l->b + i);
    for (int64_t i = 0; i < N + l->others; i++)
        l->r[i] = i < n ? m->g[i] : i < N ? m->b[i - n] : l->b[i - N];
    if (!factored(l) || !vanish(l, s->still, s->counts[1]))
        return OPEN_NUMBER;
    return l->others ? claimed(s, m, l) : DECIDED;
}

/* Whether all that may be zero is: DECIDED, with the claims. */
int zeros(Proof *s, Room *m)
{
    size_t n = (size_t)s->n_v, N = n + (size_t)s->working;
    Lifting l = {.s = s, .m = m, .N = (int64_t)N};
    s->claims[0] = s->counts[0] == 0;
    s->claims[1] = 1;
    l.others = unspanned(s, m->table, m->pivot, m->others);
    if (!l.others && !s->counts[1])
        return DECIDED;
    size_t others = (size_t)l.others, numbers = N + 2 * others + others * n;
    char *at = malloc(numbers * sizeof(Number) + N * sizeof(Float) + (N * N + 2 * N + 2 * others) * sizeof(uint64_t));
    if (!at)
        return NO_MEMORY;
    l.r = (Number *)at;
    l.b = l.r + N + others;
    l.A = l.b + others;
    l.digit = (Float *)(l.A + others * n);
    l.LU = (uint64_t *)(l.digit + N);
    l.d = l.LU + N * N;
    l.order = (int64_t *)(l.d + N);
    l.weight = l.order + N;
    l.sign = l.weight + others;
    int code = decided(s, m, &l, m->others);
    free(at);
    return code;
}
