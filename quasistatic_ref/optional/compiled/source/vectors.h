/* Vectors of three numbers, and poses [R, t] (3 x 4). Sums of products are those of numbers/ordered: over
   rising indices, from the first, each product and each sum rounded. */

#include <float.h>
#include <math.h>
#include <stdint.h>


#if FLT_EVAL_METHOD != 0
#error "float64 operations must be rounded to float64"
#endif

static inline double larger(double a, double b) { return a > b ? a : b; }
static inline double smaller(double a, double b) { return a < b ? a : b; }

static inline double dot(const double *a, const double *b)
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

/* R v, and R v + t. */
static inline void turned(const double *pose, const double *v, double *out)
{
    for (int i = 0; i < 3; i++)
        out[i] = dot(pose + 4 * i, v);
}

static inline void carried(const double *pose, const double *v, double *out)
{
    for (int i = 0; i < 3; i++)
        out[i] = dot(pose + 4 * i, v) + pose[4 * i + 3];
}
