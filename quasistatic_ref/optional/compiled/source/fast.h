/* What Python sees of the compiled code: library.py declares this file to cffi as it stands, so that it
   has no directives. All numbers are those of the notation, in its units; arrays are by rows.

   Each function does what the Python function that its comment names does, in the same order of
   operations, so that the bits are the same. */

/* Of the sources: build.py. */
const char *digest(void);

/* A cloud and a solid, whose frames are given by three arrays each: R (by columns) and t of the link, and
   [R, t] of the shape on it (3 x 4). */
typedef struct {
    int64_t is_half_space, cloud_is_alpha, points, count;
    /* Half extents of the core and the radius of the ball about each of its points; or normal, offset. */
    const double *size;
    const double *resolution; /* to whose multiples distances are rounded before they rank; 0: not */
    const double *R_solid, *t_solid, *solid_on_link, *R_cloud, *t_cloud, *cloud_on_link, *point;
    double *distance; /* of each point: a workspace */
    /* Written: the contacts, `count` of them. */
    double *phi, *n, *alpha, *beta;
    int64_t *index;
} Cloud;

int closest_of_cloud(const Cloud *s);

/* Contacts, and the load. J and A have a contact's own columns, `most_joints` of them: the first ones are
   written, the last ones stay zero where fewer coordinates move it. */
typedef struct {
    /* Contacts; coordinates, actuated ones; the most joint columns of a contact. */
    int64_t n_c, n_v, n_a, most_joints;
    /* Addresses of pinocchio's columns, and of its gravity on the left of M dv + g = tau. */
    const double *const *column, *const *gravity;
    /* Of each contact: how many columns of joints move it, which, to which of its own columns each is
       added, and whether it moves alpha's body or beta's; its number of rows and its friction. */
    const int64_t *joints, *joint, *coordinate;
    const double *moves_alpha, *moves_beta;
    const int64_t *rows;
    const double *mu_v, *mu_omega;
    /* The cone: coefficients of slip_1, slip_2, spin in each row, and which of them it has. */
    const double *coefficient;
    const int64_t *has;
    const double *h, *weighs, *force, *K_q, *delta_q_bar_a;
    const double *phi, *n, *alpha, *beta;
    double *work; /* 23 most_joints */
    /* Written: d1, d2, J; A, b; tau and g. */
    double *d1, *d2, *J, *A, *b, *tau, *g;
} Rows;

void contact_rows(const Rows *s);
void load(const Rows *s);

/* A program in natural units, group by group: coordinates and rows of a group stand next to each other. */
typedef struct {
    int64_t n, m, groups, columns;
    /* Of each group how many coordinates it has, and which, group after group; which rows. */
    const int64_t *width, *coordinate, *row;
    /* Of each row of A its columns' coordinates, and where they are in natural_A; (m, columns). A
       column that stands for none is zero, and is in the last place, which no group has. */
    const int64_t *column, *place;
    const double *g, *A, *b;
    /* The units S of coordinates, their squares, and H^-1 of each group. */
    const double *unit, *squared, *inverse;
    double *squares; /* m: a workspace */
    /* Written: {length, size}; -g, A and b in natural units. */
    double *units, *f, *natural_A, *natural_b;
} Natural;

int natural_units(Natural *s);
void natural_program(Natural *s);

/* q (+) delta_q of joints, each of a kind, with its entries of q and of delta_q. */
typedef struct {
    int64_t joints;
    const int64_t *kind, *q_start, *v_start;
    double *angle, *cosine, *sine; /* how far each joint turns [rad]; of half of that */
    const double *q, *delta_q;
    double *q_next; /* written */
    int64_t actuated; /* joints, the first of all */
    const double *here, *target;
    double *delta_q_bar_a; /* written: target (-) here */
} Sums;

int half_turns(Sums *s);
void sums(const Sums *s);
int differences(const Sums *s);
double squared_distances(int64_t links, const double *const *t);
