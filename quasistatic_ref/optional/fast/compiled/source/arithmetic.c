/* No function of the core: test_cache.py. The operations that all other files are made of, on numbers
   that show what a compiler has made of them: selftest.py knows the bits of the results. */

#include "solid.h"

/* Of n triples x, y, z eight results each; then two sums over the first `count` of them. */
void arithmetic(const double *triples, int64_t n, int64_t count, double *out)
{
    double by = triples[1], total = 0.0, products = 0.0;
    for (int64_t i = 0; i < n; i++) {
        double x = triples[3 * i], y = triples[3 * i + 1], z = triples[3 * i + 2];
        *out++ = x * y + z;
        *out++ = x + y - x;
        *out++ = x / by;
        *out++ = x / 3.0;
        *out++ = x * 0.1;
        *out++ = 0.0 - x;
        *out++ = sqrt(y);
        *out++ = x == x;
    }
    for (int64_t i = 0; i < count; i++)
        total += triples[3 * i];
    for (int64_t i = 0; i < count; i++)
        products += triples[3 * i] * triples[3 * i + 1];
    *out++ = total;
    *out = products;
}
