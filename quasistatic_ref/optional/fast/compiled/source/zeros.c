/* certify/dependence.follow and certify/degeneracy, with test_zeros.py: zeros of the optimum, and what
   rows without slack mean, without rounding: docs/proofs.md.

   K z = f is solved modulo powers of p = 2^56 - 5, some coordinates being zero. M is what K has in the
   other columns, and M_B some of its rows, as many as columns. The digits of these unknowns to the base
   p, the last first, are d = M_B^-1 r_B mod p, where r is f at first, and (r - M d) / p from then on. */

#include <math.h>
#include <stdlib.h>

#include "proof.h"

#define P (((uint64_t)1 << BITS) - 5)
#define FIFTH 0xCCCCCCCCCCCCCDu /* 5 FIFTH = 1 modulo 2^56 */

typedef unsigned __int128 Wide;

typedef struct {
    const Proof *s;
    const Workspace *m;
    int64_t N, others; /* unknowns; rows outside of the working set */
    int64_t columns, *column; /* of the M that is factorised; -1 before */
    uint64_t *LU, *d; /* factors of M_B modulo p; one digit of each unknown, behind what is solved for */
    int64_t *order; /* of the rows of K in LU: first those of M_B */
    int64_t *rows;  /* that have entries in M, in this order, and the others */
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

/* The entry of K in a row and a column, the unknowns being x and -y; or of another row. */
static const Number *entry(const Lifting *l, int64_t i, int64_t j)
{
    int64_t n = l->s->n_v;
    const Number *H = l->s->hessian, *A = l->m->A;
    if (j >= n)
        return i < n ? A + (j - n) * n + i : &ZERO;
    return i < n ? H + i * n + j : i < l->N ? A + (i - n) * n + j : l->A + (i - l->N) * n + j;
}

/* M_B = LU modulo p, rows exchanged, with -L and the reciprocal pivots in place; 0 if it is singular.
   Coordinates that rest, or all if NULL, are zero. */
static int factored(Lifting *l, const char *rests)
{
    int64_t N = l->N, M = 0;
    for (int64_t j = 0; j < N; j++) {
        l->order[j] = j;
        if (j >= l->s->n_v || (rests && !rests[j]))
            l->column[M++] = j;
    }
    for (int64_t i = 0; i < N; i++)
        for (int64_t c = 0; c < M; c++)
            l->LU[i * M + c] = residue(entry(l, i, l->column[c]));
    for (int64_t c = 0; c < M; c++) {
        int64_t p = c;
        while (p < N && !l->LU[p * M + c])
            p++;
        if (p == N)
            return 0;
        uint64_t *row = l->LU + c * M, *other = l->LU + p * M;
        for (int64_t j = 0; j < M && p != c; j++) {
            uint64_t x = row[j];
            row[j] = other[j];
            other[j] = x;
        }
        int64_t at = l->order[c];
        l->order[c] = l->order[p];
        l->order[p] = at;
        row[c] = reciprocal(row[c]);
        for (int64_t i = c + 1; i < N; i++) {
            other = l->LU + i * M;
            if (!other[c])
                continue;
            other[c] = P - modulo((Wide)other[c] * row[c]);
            for (int64_t j = c + 1; j < M; j++)
                if (row[j])
                    other[j] = modulo((Wide)other[c] * row[j] + other[j]);
        }
    }
    l->columns = M;
    return 1;
}

/* The next digits: d = M_B^-1 r_B modulo p. */
static void digits(Lifting *l)
{
    int64_t M = l->columns;
    uint64_t *d = l->d;
    for (int64_t i = 0; i < M; i++) {
        Wide sum = residue(l->r + l->order[i]);
        for (int64_t j = 0; j < i; j++)
            sum += (Wide)l->LU[i * M + j] * d[j];
        d[i] = modulo(sum);
    }
    for (int64_t i = M - 1; i >= 0; i--) {
        Wide sum = 0;
        for (int64_t j = i + 1; j < M; j++)
            sum += (Wide)l->LU[i * M + j] * d[j];
        d[i] = modulo((Wide)(d[i] + P - modulo(sum)) * l->LU[i * M + i]);
    }
    for (int64_t i = 0; i < M; i++)
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
static double bits_of(double of_a, double size, const Number *f, double *of_f)
{
    *of_f = fmin(*of_f, lower(of_a, f) - of_a);
    return log2(size + fabs(value(f))) - of_a;
}

/* Whether a row has no entries in M's columns. */
static int vacant(const Lifting *l, int64_t i)
{
    int none = 1;
    for (int64_t c = 0; c < l->columns && none; c++)
        none = empty(entry(l, i, l->column[c]));
    return none;
}

/* Bits of the whole numbers of which the unknowns, and what M_B leaves of other rows, are quotients:
   Hadamard's bound of determinants, each row and column as a multiple of a power of two. */
static double bits(const Lifting *l, int64_t count)
{
    int64_t n = l->s->n_v, M = l->columns;
    double sum = 2.0, of_f = 0.0, most = 0.0, *of_H = l->m->rest;
    for (int64_t k = 0; k < count; k++) {
        int64_t i = l->rows[k];
        double size = 0.0, of_a = INFINITY;
        for (int64_t c = 0; c < M; c++) {
            const Number *x = entry(l, i, l->column[c]);
            size += fabs(value(x));
            of_a = l->column[c] < n ? lower(of_a, x) : of_a;
        }
        of_a = of_a < INFINITY ? of_a : 0.0; /* of a row without such entries */
        if (i < n)
            of_H[i] = of_a;
        double own = bits_of(of_a, size, l->r + i, &of_f);
        if (k < M)
            sum += own;
        else
            most = fmax(most, own);
    }
    for (int64_t c = 0; c < M; c++) { /* the columns of y */
        double of_y = 0.0;
        for (int64_t k = 0, i; k < count && l->column[c] >= n; k++)
            if ((i = l->rows[k]) < n)
                of_y = fmin(of_y, lower(of_H[i], entry(l, i, l->column[c])) - of_H[i]);
        sum -= of_y;
    }
    return sum - of_f + most;
}

/* Whether all rows hold where the coordinates outside of M are zero: those of K, and the others. */
static int holds(Lifting *l)
{
    const Proof *s = l->s;
    int64_t N = l->N, count = 0;
    Sum sum = EMPTY;
    for (int64_t j = 0; j < N + l->others; j++) {
        int64_t i = j < N ? l->order[j] : j;
        if (!vacant(l, i))
            l->rows[count++] = i;
        else if (!empty(l->r + i))
            return 0;
    }
    if (count == l->columns) /* M_B is regular */
        return !lost;
    for (double left = bits(l, count); left >= 0.0; left -= BITS - 1) {
        digits(l);
        s->counts[2]++;
        for (int64_t k = 0; k < count; k++) {
            int64_t i = l->rows[k];
            add(&sum, l->r + i);
            for (int64_t c = 0; c < l->columns; c++)
                add_product(&sum, entry(l, i, l->column[c]), l->digit[c], -1);
            if (!divided(&sum, l->r + i))
                return 0;
        }
    }
    return !lost;
}

/* The solution of hH v - A_W'y = a and A_W v = 0 is asked for next. */
static void pressed_by(const Lifting *l, const Number *a, Number *r)
{
    memset(r, 0, (size_t)l->N * sizeof(Number));
    memcpy(r, a, (size_t)l->s->n_v * sizeof(Number));
}

/* Whether W spans a row: v is zero then. */
static int spanned(Lifting *l, const Number *a)
{
    int64_t n = l->s->n_v;
    l->others = 0;
    pressed_by(l, a, l->r);
    return (l->columns == l->N - n || factored(l, NULL)) && holds(l);
}

/* v and y within m->e; 0 if that is not shown. */
static int found(const Lifting *l, Workspace *m, const Number *a)
{
    pressed_by(l, a, m->r);
    memset(m->z, 0, (size_t)l->N * sizeof(Number));
    refined(l->s, m, REFINED);
    return !lost && error_bounds(m->R, m->G, m->rest, l->N, m->e);
}

/* The weighted sum of some rows, n Numbers each; of the weights 30 bits are taken. */
static void summed(const Number *rows, const double *weight, int64_t count, int64_t n, Number *out)
{
    double most = 0.0;
    Sum sum = EMPTY;
    for (int64_t i = 0; i < count; i++)
        most = fmax(most, weight[i]);
    for (int64_t v = 0; v < n; v++) {
        for (int64_t i = 0; i < count; i++)
            add_product(&sum, rows + i * n + v, exact(rint(0x1p30 * weight[i] / most)), 1);
        carried(&sum, out + v);
    }
}

/* Whether v, which is found, surely opens all of some rows. */
static int opened(const Workspace *m, const Number *rows, int64_t count, int64_t n)
{
    int all = 1;
    for (int64_t i = 0; i < count; i++) {
        double along = 0.0, error = 0.0;
        for (int64_t v = 0; v < n; v++) {
            double a = value(rows + i * n + v), x = value(m->z + v);
            along += a * x;
            error += fabs(a) * (m->e[v] + fabs(x) * 0x1p-40);
        }
        all &= along * DOWN > error * UP;
    }
    return all;
}

/* The workspace of the lifting of a system, with so many other rows, to be freed; NULL without memory. */
static void *lifting(Lifting *l, const Proof *s, const Workspace *m, int64_t others)
{
    size_t n = (size_t)s->n_v, N = n + (size_t)s->working, count = (size_t)others;
    size_t numbers = N + 2 * count + count * n;
    size_t integers = N * N + 4 * N + count;
    char *at = malloc(numbers * sizeof(Number) + N * sizeof(Float) + integers * sizeof(uint64_t));
    l->s = s;
    l->m = m;
    l->N = (int64_t)N;
    l->others = others;
    l->columns = -1;
    l->r = (Number *)at;
    l->b = l->r + N + count;
    l->A = l->b + count;
    l->digit = (Float *)(l->A + count * n);
    l->LU = (uint64_t *)(l->digit + N);
    l->d = l->LU + N * N;
    l->order = (int64_t *)(l->d + N);
    l->column = l->order + N;
    l->rows = l->column + N;
    return at;
}

/* E: rows without slack of which it is open whether some motion opens them. */
typedef struct {
    int64_t count, *row;
    Number *A;
    double *weight;
} Rows;

static void left_out(Rows *E, int64_t i, int64_t n)
{
    int64_t after = --E->count - i;
    memmove(E->row + i, E->row + i + 1, (size_t)after * sizeof(int64_t));
    memmove(E->A + i * n, E->A + (i + 1) * n, (size_t)(after * n) * sizeof(Number));
}

static int settled(Proof *s, Workspace *m, Lifting *l, Rows *E, Number *sum);

/* The same for W and the rows of E that have a weight, but one, the last: these with it, times
   positive numbers, come to a combination of W's rows. */
static int joined(Proof *s, Rows *E, int64_t last, Number *sum)
{
    Proof wider = *s;
    Workspace m;
    Lifting l;
    int64_t n = s->n_v, k = s->working, code = OPEN_CLAIM;
    int64_t *guess = malloc((size_t)(k + E->count) * sizeof(int64_t));
    void *workspace = NULL, *digits = NULL;
    wider.guess = guess;
    if (guess) {
        memcpy(guess, s->guess, (size_t)k * sizeof(int64_t));
        for (int64_t i = E->count - 1; i >= 0; i--)
            if (E->row[i] == last || E->weight[i] > 0.0) {
                if (E->row[i] == last)
                    memcpy(sum, E->A + i * n, (size_t)n * sizeof(Number));
                else
                    guess[wider.working++] = E->row[i];
                left_out(E, i, n);
            }
        workspace = wider.working <= n ? workspace_of(&wider, &m) : NULL;
    }
    if (workspace && regular(&wider, &m) == DECIDED)
        digits = lifting(&l, &wider, &m, 0);
    if (digits && spanned(&l, sum) && found(&l, &m, sum)) {
        int positive = 1;
        for (int64_t w = n + k; w < l.N; w++) /* `last` and A'y come to zero */
            positive &= value(m.z + w) * DOWN > m.e[w];
        s->claims[0] = s->claims[0] && !positive;
        code = positive ? settled(&wider, &m, &l, E, sum) : OPEN_CLAIM;
    }
    free(digits);
    free(workspace);
    free(guess);
    return (int)code;
}

/* What E means: docs/proofs.md. */
static int settled(Proof *s, Workspace *m, Lifting *l, Rows *E, Number *sum)
{
    int64_t n = s->n_v;
    for (int64_t i = 0; i < E->count; i++)
        E->weight[i] = 1.0;
    summed(E->A, E->weight, E->count, n, sum);
    if (spanned(l, sum)) {
        s->claims[0] = s->claims[0] && !E->count;
        return DECIDED;
    }
    for (int64_t i = E->count - 1; i >= 0; i--)
        if (spanned(l, E->A + i * n)) {
            s->claims[0] = 0;
            left_out(E, i, n);
        }
    int64_t last = closed(s, E->row, E->count, E->weight);
    if (last >= 0)
        return joined(s, E, last, sum);
    summed(E->A, E->weight, E->count, n, sum);
    s->claims[1] = 0;
    return found(l, m, sum) && opened(m, E->A, E->count, n) ? DECIDED : OPEN_CLAIM;
}

/* The row a x = b by which an entry of A'lam is zero: (hH)x = hg. */
static void balance(const Proof *s, const Workspace *m, int64_t v, Number *a, Number *b)
{
    memcpy(a, (const Number *)s->hessian + v * s->n_v, (size_t)s->n_v * sizeof(Number));
    *b = m->g[v];
}

/* The row a x = b by which a number is half-way between two others. */
static void half(const Proof *s, const Workspace *m, const Tie *tie, Number *a, Number *b)
{
    Number zero = ZERO;
    if (tie->of == OF_SLACK)
        row_of(s, tie->at, a, &zero);
    else if (tie->of == OF_NET)
        balance(s, m, tie->at, a, &zero);
    else {
        memset(a, 0, (size_t)s->n_v * sizeof(Number));
        a[tie->at] = number(exact(1.0));
    }
    total(&zero, &tie->middle, b);
}

/* Whether all that may be zero is, and half-way what may be; and what the others mean, which are rows
   that do not follow from how the rows of contacts are combined. */
static int decided(Proof *s, Workspace *m, Lifting *l, int64_t count)
{
    int64_t n = s->n_v, N = l->N, ties = count + m->balances;
    for (int64_t i = 0; i < l->others; i++) {
        Number *a = l->A + i * n, *b = l->b + i;
        if (i < count)
            row_of(s, m->others[i], a, b);
        else if (i < ties)
            balance(s, m, m->balanced[i - count], a, b);
        else
            half(s, m, m->tie + (i - ties), a, b);
    }
    for (int64_t i = 0; i < N + l->others; i++)
        l->r[i] = i < n ? m->g[i] : i < N ? m->b[i - n] : l->b[i - N];
    if (!factored(l, m->rests) || !holds(l))
        return OPEN_NUMBER;
    if (!count)
        return DECIDED;
    Rows E = {count, m->others, l->A, calloc((size_t)count, sizeof(double))};
    Number *sum = malloc((size_t)n * sizeof(Number));
    s->claims[0] = s->counts[0] == count;
    int code = E.weight && sum ? settled(s, m, l, &E, sum) : NO_MEMORY;
    free(E.weight);
    free(sum);
    return code;
}

/* Whether all that may be zero is: DECIDED, with the claims. */
int zeros(Proof *s, Workspace *m)
{
    Lifting l;
    s->claims[0] = s->counts[0] == 0;
    s->claims[1] = 1;
    int64_t count = unspanned(s, m->table, m->pivot, m->others);
    if (!count && !s->counts[1] && !m->balances && !m->ties)
        return DECIDED;
    void *workspace = lifting(&l, s, m, count + m->balances + m->ties);
    int code = workspace ? decided(s, m, &l, count) : NO_MEMORY;
    free(workspace);
    return code;
}

/* Whether the solution x of K x = f, K being s->hessian, satisfies A x = b: `count` rows. */
int satisfied(const Proof *s, const Workspace *m, const Number *f, const Number *A, const Number *b,
              int64_t count)
{
    Lifting l;
    size_t n = (size_t)s->n_v;
    void *workspace = lifting(&l, s, m, count);
    if (!workspace)
        return NO_MEMORY;
    memcpy(l.r, f, n * sizeof(Number));
    memcpy(l.r + n, b, (size_t)count * sizeof(Number));
    memcpy(l.A, A, (size_t)count * n * sizeof(Number));
    int code = factored(&l, m->rests) && holds(&l) ? DECIDED : OPEN_NUMBER;
    free(workspace);
    return code;
}
