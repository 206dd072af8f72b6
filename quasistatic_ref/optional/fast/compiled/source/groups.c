/* step/groups.group_steps, each in natural units of its own, with test_groups.py; and each proved on the
   rows that an answer presses: optional/fast/proofs. */

#include <string.h>

#include "proof.h"

enum { GUESSES = 16 }; /* that follow one that is wrong; boxes in a row at rest take four to ten */

/* structure.py reads this: 64-bit integers, then pointers. */
typedef struct {
    int64_t groups;
    Proof *const *group; /* 0: of one that is not proved here */
    /* The step, and its standard form, J and A as they are kept: whole, or without their zeros; lam
       and slacks of an answer in natural units. */
    const double *delta_q_bar_a, *tau, *phi, *frame, *J, *mu, *g, *A, *b, *pressure, *gap;
    /* What the proof of each group comes to; the optimum of those that are DECIDED, as in
       Proof. */
    int64_t *code;
    double *delta_q, *lam, *net, *slack, *rest, *bound, *least;
    int64_t *claims;
} Step;

/* Some numbers, -1 standing for a zero: whether one has changed. */
static int taken(double *to, const double *from, const int64_t *at, int64_t n)
{
    int changed = 0;
    for (int64_t i = 0; i < n; i++) {
        double x = at[i] < 0 ? 0.0 : from[at[i]];
        changed |= x != to[i];
        to[i] = x;
    }
    return changed;
}

/* The same of rows of some width, which stand one after the other. */
static int rows_taken(double *to, const double *from, const int64_t *at, int64_t n, int64_t width)
{
    int changed = 0;
    for (int64_t i = 0; i < n * width; i++) {
        double x = from[at[i / width] * width + i % width];
        changed |= x != to[i];
        to[i] = x;
    }
    return changed;
}

static void given(double *to, const double *from, const int64_t *index, int64_t n)
{
    for (int64_t i = 0; i < n; i++)
        to[index[i]] = from[i];
}

/* The standard form of a group, and the answer. */
static void form_taken(const Step *s, Proof *p)
{
    const int64_t *r = p->rows_of_step;
    int64_t n = p->n_v, m = p->rows;
    taken(p->g, s->g, p->coordinates, n);
    taken(p->A, s->A, p->in_A, m * n);
    taken(p->b, s->b, r, m);
    taken(p->pressure, s->pressure, r, m);
    taken(p->gap, s->gap, r, m);
}

/* The data of a group: whether they have changed. */
static int posed(const Step *s, Proof *p)
{
    const int64_t *v = p->coordinates, *c = p->contacts;
    int64_t n = p->n_v, n_c = p->n_c;
    int changed = 0;
    changed |= taken(p->delta_q_bar_a, s->delta_q_bar_a, v, p->n_a);
    changed |= taken(p->tau, s->tau, v, n);
    changed |= taken(p->phi, s->phi, c, n_c);
    changed |= rows_taken(p->frame, s->frame, c, n_c, 16);
    changed |= rows_taken(p->mu, s->mu, c, n_c, 4);
    changed |= taken(p->J, s->J, p->in_J, 4 * n_c * n);
    return changed;
}

/* The rows that the answer presses: whether they have changed. */
static int answered(Proof *p)
{
    int64_t k = 0;
    int changed = 0;
    for (int64_t r = 0; r < p->rows; r++)
        if (p->pressure[r] > 0.0 && p->pressure[r] > p->gap[r]) {
            changed |= p->answer[k] != r;
            p->answer[k++] = r;
        }
    changed |= p->answered != k;
    p->answered = k;
    return changed;
}

/* What the proof on these rows comes to, or on the guess that is found from them. */
int proof_nearby(Proof *p)
{
    p->working = p->answered;
    memcpy(p->guess, p->answer, (size_t)p->answered * sizeof(int64_t));
    int code = p->working > p->n_v ? SINGULAR : proof(p);
    if ((code == SINGULAR || code == OPEN_BOUND) && independent(p))
        code = proof(p);
    for (int tries = 0; code == REFUTED && tries < GUESSES && mended(p); tries++)
        code = proof(p);
    p->code = code;
    return code;
}

/* Whether a group whose answer presses nothing is DECIDED on the rows of another of equal constants. */
static int proof_like(Proof *p, const Proof *other)
{
    if (p->answered || !other || !other->working || other->hessian != p->hessian)
        return 0;
    p->working = other->working;
    memcpy(p->guess, other->guess, (size_t)p->working * sizeof(int64_t));
    return proof(p) == DECIDED;
}

/* What comes of the last optimum's rows, as long as the answer presses what it pressed then; or of
   those of the answer, or of the group before. */
static int proof_again(Proof *p, int same_answer, const Proof *before)
{
    if ((same_answer && p->code == DECIDED && proof(p) == DECIDED) || proof_like(p, before))
        return (int)p->code;
    return proof_nearby(p);
}

/* Whether all groups are DECIDED. A group of which nothing has changed, nor its answer, is as it was. */
int groups_proved(Step *s)
{
    int all = 1;
    const Proof *before = NULL;
    s->least[0] = s->least[1] = INFINITY;
    s->claims[0] = s->claims[1] = 1;
    for (int64_t i = 0; i < s->groups; i++) {
        Proof *p = s->group[i];
        s->code[i] = NOT_POSED;
        if (p) {
            form_taken(s, p);
            int changed = posed(s, p), same_answer = !answered(p);
            if (!changed && same_answer && p->code != NOT_POSED)
                s->code[i] = p->code;
            else if (natural_units(p->natural))
                s->code[i] = proof_again(p, same_answer, before);
            else
                p->code = NOT_POSED;
        }
        if (s->code[i] != DECIDED) {
            all = 0;
            continue;
        }
        before = p;
        given(s->delta_q, p->delta_q, p->coordinates, p->n_v);
        given(s->net, p->net, p->coordinates, p->n_v);
        given(s->rest, p->rest, p->coordinates, p->n_v);
        given(s->bound, p->bound, p->coordinates, p->n_v);
        given(s->lam, p->lam, p->rows_of_step, p->rows);
        given(s->slack, p->slack, p->rows_of_step, p->rows);
        for (int k = 0; k < 2; k++) {
            s->least[k] = p->least[k] < s->least[k] ? p->least[k] : s->least[k];
            s->claims[k] = s->claims[k] && p->claims[k];
        }
    }
    return all;
}
