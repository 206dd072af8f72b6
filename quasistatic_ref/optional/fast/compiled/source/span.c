/* certify/dependence.follow, by how the rows of a contact are combined, with test_zeros.py. */

#include "proof.h"

/* Entries of the four generators of a contact's rows: gap, two slips, and a spin that contacts of
   equal or opposite spins and one coefficient have in common. certify/dependence. */
static void generators(const Proof *s, int64_t r, int64_t *x)
{
    int64_t c = s->contact[r], n_v = s->n_v, owner = c, sign = 1;
    const int64_t *entry = s->integers + 4 * s->row[r];
    for (int64_t i = 0; i < 4 * s->n_c; i++)
        x[i] = 0;
    const double *mu = s->mu + 4 * c;
    for (int a = 0; a < 3; a++)
        x[3 * c + a] = mu[a] != 0.0 ? entry[a] : 0;
    if (mu[3] == 0.0 || entry[3] == 0)
        return;
    const double *spin = s->J + n_v * (4 * c + 3);
    for (int64_t d = 0; d < c && owner == c; d++) {
        const double *other = s->J + n_v * (4 * d + 3);
        int same = s->mu[4 * d + 3] == mu[3], opposite = same;
        for (int64_t v = 0; v < n_v && (same || opposite); v++) {
            same = same && spin[v] == other[v];
            opposite = opposite && spin[v] == -other[v];
        }
        if (same || opposite) {
            owner = d;
            sign = same ? 1 : -1;
        }
    }
    x[3 * s->n_c + owner] = sign * entry[3];
}

/* The idle rows that do not combine those of the working set whatever J is, and their number; those
   also whose integers grow. */
int64_t unspanned(const Proof *s, int64_t *table, int64_t *pivot, int64_t *others)
{
    int64_t width = 4 * s->n_c, k = s->working, count = s->counts[0], held = 0, found = 0;
    for (int64_t w = 0; count && w < k + count; w++) {
        int64_t r = w < k ? s->guess[w] : s->idle[w - k], *x = table + held * width, first = -1, ok = 1;
        generators(s, r, x);
        for (int64_t i = 0; i < held && ok; i++) {
            const int64_t *other = table + i * width;
            int64_t a = x[pivot[i]], p = other[pivot[i]];
            for (int64_t j = 0; a && ok && j < width; j++) {
                int64_t one, two;
                ok = !__builtin_mul_overflow(x[j], p, &one) && !__builtin_mul_overflow(other[j], a, &two)
                  && !__builtin_sub_overflow(one, two, x + j);
            }
        }
        for (int64_t j = width - 1; j >= 0; j--)
            if (x[j])
                first = j;
        if (w >= k && (first >= 0 || !ok))
            others[found++] = r;
        if (w < k && first >= 0 && ok)
            pivot[held++] = first;
    }
    return found;
}
