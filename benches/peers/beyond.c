/* The explicit scheme beyond the paper as plain loops: tips that move outward,
 * friction, and a casing that is rigid or has a lining. Four coordinates, all
 * blades in every step, one sine and cosine a step.
 *
 *   beyond KEY=VALUE...
 *
 * with the keys of a scene of 22 blades, and `repeats`. Prints JSON: the steps,
 * processor seconds of each repeat, how many steps had how many rows (rigid
 * casing), and the final state. Written from sections 1, 6 and 10 of
 * docs/theory.md; nothing is skipped. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { BLADES = 22, ROWS = 8 };

static int words;
static char **word;

static const char *text(const char *key)
{
    size_t length = strlen(key);
    for (int i = 1; i < words; i++)
        if (strncmp(word[i], key, length) == 0 && word[i][length] == '=')
            return word[i] + length + 1;
    fprintf(stderr, "beyond: no %s\n", key);
    exit(2);
}

static double number(const char *key) { return atof(text(key)); }

struct coordinate { double x, step, keep, compliance, stiffness; };

/* Position x and rate v; the step before follows from the acceleration at once. */
static struct coordinate coordinate(double mass, double stiffness, double zeta, double h,
                                    double x, double v, double force)
{
    double inertia = mass / (h * h), drag = zeta * sqrt(mass * stiffness) / h;
    double acceleration = (force - 2 * h * drag * v - stiffness * x) / mass;
    return (struct coordinate){x, h * v - h * h / 2 * acceleration,
                               (inertia - drag) / (inertia + drag), 1 / (inertia + drag), stiffness};
}

static void predict(struct coordinate *c, double force)
{
    c->step = c->keep * c->step + c->compliance * (force - c->stiffness * c->x);
    c->x += c->step;
}

static int diameters, groups; /* of blades with the same phase: one row */
static double g0, kappa_l, both_l;          /* kappa l_b, (kappa + mu) l_b */
static double mu_c, lining, smoothing, speed;
static double cosine[BLADES], sine[BLADES]; /* of n_d Phi_i */
static double c[BLADES], s[BLADES];         /* of n_d (Phi_i + alpha_i) */
static double gap[BLADES];

/* Gaps of all blades. (across, along) is the casing seen from the rotor. */
static void gaps(double across, double along, double a_c, double a_s)
{
    if (diameters * sqrt(a_c * a_c + a_s * a_s) < 1.0 / 64) {
        for (int i = 0; i < BLADES; i++) {
            double alpha = cosine[i] * a_c + sine[i] * a_s, d = diameters * alpha, q = d * d;
            double small_s = d * (1 - q * (1 / 6.0) * (1 - q * (1 / 20.0) * (1 - q * (1 / 42.0))));
            double small_c = 1 - q * (1 / 2.0) * (1 - q * (1 / 12.0) * (1 - q * (1 / 30.0)));
            c[i] = cosine[i] * small_c - sine[i] * small_s;
            s[i] = sine[i] * small_c + cosine[i] * small_s;
            gap[i] = g0 + across * c[i] + along * s[i] - kappa_l * alpha;
        }
        return;
    }
    for (int i = 0; i < BLADES; i++) {
        double alpha = cosine[i] * a_c + sine[i] * a_s, d = diameters * alpha;
        c[i] = cosine[i] * cos(d) - sine[i] * sin(d);
        s[i] = sine[i] * cos(d) + cosine[i] * sin(d);
        gap[i] = g0 + across * c[i] + along * s[i] - kappa_l * alpha;
    }
}

/* Forces of the lining on the four coordinates, where they are at the angle n_d theta. */
static void press(const struct coordinate q[4], double angle, double force[4])
{
    double turn_c = cos(angle), turn_s = sin(angle);
    double across = turn_c * q[0].x + turn_s * q[1].x, along = turn_c * q[1].x - turn_s * q[0].x;
    gaps(across, along, q[2].x, q[3].x);
    double out_c = 0, out_s = 0, torque_c = 0, torque_s = 0, half = 0.5 / smoothing;
    for (int i = 0; i < BLADES; i++) {
        double depth = gap[i] < 0 ? -gap[i] : 0;
        double push = lining * (depth < smoothing ? half * depth * depth : depth - smoothing / 2);
        double torque = push * (diameters * (along * c[i] - across * s[i]) - both_l);
        out_c += push * c[i];
        out_s += push * s[i];
        torque_c += torque * cosine[i];
        torque_s += torque * sine[i];
    }
    double drag_c = out_c - mu_c * out_s, drag_s = out_s + mu_c * out_c;
    force[0] = turn_c * drag_c - turn_s * drag_s;
    force[1] = turn_s * drag_c + turn_c * drag_s;
    force[2] = torque_c;
    force[3] = torque_s;
}

/* Pushes p >= 0 with w p + g >= 0 and one of both zero: the rows that press are
 * solved as equalities; of the rows that are wrong the first changes sides. */
static int complement(int rows, double w[ROWS][ROWS], const double *g, double *p)
{
    unsigned set = (1u << rows) - 1;
    for (int tries = 0; tries < 1000; tries++) {
        int index[ROWS], n = 0;
        double m[ROWS][ROWS + 1];
        for (int i = 0; i < rows; i++)
            if (set >> i & 1)
                index[n++] = i;
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++)
                m[i][j] = w[index[i]][index[j]];
            m[i][n] = -g[index[i]];
        }
        for (int k = 0; k < n; k++)
            for (int i = k + 1; i < n; i++) {
                double by = m[i][k] / m[k][k];
                for (int j = k + 1; j <= n; j++)
                    m[i][j] -= by * m[k][j];
            }
        for (int i = 0; i < rows; i++)
            p[i] = 0;
        for (int i = n - 1; i >= 0; i--) {
            double sum = m[i][n];
            for (int j = i + 1; j < n; j++)
                sum -= m[i][j] * p[index[j]];
            p[index[i]] = sum / m[i][i];
        }
        int wrong = -1;
        for (int i = 0; i < rows && wrong < 0; i++) {
            double left = g[i];
            for (int j = 0; j < rows; j++)
                left += w[i][j] * p[j];
            if (set >> i & 1 ? p[i] < 0 : left < 0)
                wrong = i;
        }
        if (wrong < 0)
            return 1;
        set ^= 1u << wrong;
    }
    return 0;
}

/* Puts predicted positions back to where no blade penetrates; returns the rows. */
static int correct(struct coordinate q[4], double angle)
{
    double turn_c = cos(angle), turn_s = sin(angle);
    double across = turn_c * q[0].x + turn_s * q[1].x, along = turn_c * q[1].x - turn_s * q[0].x;
    gaps(across, along, q[2].x, q[3].x);
    double row[ROWS][4], column[ROWS][4], g[ROWS], w[ROWS][ROWS], p[ROWS];
    int rows = 0;
    for (int i = 0; i < groups; i++) {
        if (gap[i] >= 0)
            continue;
        if (rows == ROWS)
            return -1;
        double b_c = turn_c * c[i] - turn_s * s[i], b_s = turn_s * c[i] + turn_c * s[i];
        double lever = diameters * (along * c[i] - across * s[i]);
        double r[4] = {b_c, b_s, (lever - kappa_l) * cosine[i], (lever - kappa_l) * sine[i]};
        double f[4] = {b_c - mu_c * b_s, b_s + mu_c * b_c, (lever - both_l) * cosine[i], (lever - both_l) * sine[i]};
        for (int k = 0; k < 4; k++) {
            row[rows][k] = r[k];
            column[rows][k] = f[k] * q[k].compliance;
        }
        g[rows++] = gap[i];
    }
    if (rows == 0)
        return 0;
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < rows; j++)
            w[i][j] = row[i][0] * column[j][0] + row[i][1] * column[j][1]
                    + row[i][2] * column[j][2] + row[i][3] * column[j][3];
    if (!complement(rows, w, g, p))
        return -1;
    for (int i = 0; i < rows; i++)
        for (int k = 0; k < 4; k++) {
            q[k].x += column[i][k] * p[i];
            q[k].step += column[i][k] * p[i];
        }
    return rows;
}

/* Mean of the pulse over the step around step n, the first one from 0. */
static double pulse(long n, double h, double force, double length)
{
    double from = fmax(n * h - h / 2, 0), to = fmin(n * h + h / 2, length);
    return from < to ? force * (to - from) / (n == 0 ? h / 2 : h) : 0;
}

int main(int argc, char **argv)
{
    words = argc;
    word = argv;
    const double turn = 2 * acos(-1), length = number("bladed_disk.blade_length_m");
    diameters = number("operation.nodal_diameters");
    if (number("bladed_disk.blades") != BLADES || diameters <= 0 || 2 * diameters >= BLADES)
        return 2;
    const char *absent[] = {"bladed_disk.nodal_diameters", "bladed_disk.mistuning", "contact.restitution",
                            "operation.speed_ramp_rad_s2", "excitation.amplitude_nm"};
    for (int i = 0; i < 5; i++)
        if (number(absent[i]) != 0)
            return 2;
    for (int i = 0; i < BLADES; i++) {
        double phase = turn * (diameters * i % BLADES) / BLADES;
        if (groups == i && (i == 0 || diameters * i % BLADES != 0))
            groups++;
        cosine[i] = cos(phase);
        sine[i] = sin(phase);
    }
    g0 = number("casing.radius_m") - length;
    kappa_l = number("bladed_disk.radial_coupling") * length;
    speed = number("operation.speed_rad_s");
    double friction = copysign(number("contact.friction"), speed); /* in the sense of rotation */
    both_l = kappa_l + friction * length;
    mu_c = friction * number("casing.tangential_ratio");
    lining = number("contact.stiffness_n_per_m");
    smoothing = number("contact.smoothing_m");
    double h = number("solver.step_s"), mass = number("casing.modal_mass_kg");
    double stiffness = number("casing.modal_stiffness_n_per_m"), zeta = number("casing.damping_ratio");
    double inertia = BLADES * number("bladed_disk.inertia_kg_m2") / 2, zeta_b = number("bladed_disk.damping_ratio");
    double spring = BLADES / 2.0 * (number("bladed_disk.stiffness_nm_per_rad")
                  + 2 * number("bladed_disk.coupling_nm_per_rad") * (1 - cos(turn * diameters / BLADES)));
    double blow = number("operation.pulse_n"), blow_s = number("operation.pulse_s");
    double u_c = number("initial.u_c_m"), u_s = number("initial.u_s_m");
    int repeats = number("repeats"), soft = strcmp(text("solver.contact"), "smooth") == 0;
    if (!soft && strcmp(text("solver.contact"), "unilateral") != 0)
        return 2;
    long steps = lround(number("solver.end_s") / h), had[ROWS + 1] = {0};
    struct coordinate q[4];
    printf("{\"steps\": %ld, \"seconds\": [", steps);
    for (int repeat = 0; repeat < repeats; repeat++) {
        struct timespec began, ended;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &began);
        double force[4] = {0};
        q[0].x = u_c, q[1].x = u_s, q[2].x = q[3].x = 0;
        if (soft)
            press(q, 0, force);
        double first = force[0] + pulse(0, h, blow, blow_s);
        q[0] = coordinate(mass, stiffness, zeta, h, u_c, number("initial.v_c_m_s"), first);
        q[1] = coordinate(mass, stiffness, zeta, h, u_s, number("initial.v_s_m_s"), force[1]);
        q[2] = coordinate(inertia, spring, zeta_b, h, 0, 0, force[2]);
        q[3] = coordinate(inertia, spring, zeta_b, h, 0, 0, force[3]);
        memset(had, 0, sizeof had);
        for (long n = 0; n < steps; n++) {
            if (soft)
                press(q, diameters * speed * (n * h), force);
            predict(&q[0], force[0] + pulse(n, h, blow, blow_s));
            for (int k = 1; k < 4; k++)
                predict(&q[k], force[k]);
            if (soft)
                continue;
            int rows = correct(q, diameters * speed * ((n + 1) * h));
            if (rows < 0)
                return 1;
            had[rows]++;
        }
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &ended);
        printf("%s%.9f", repeat ? ", " : "", ended.tv_sec - began.tv_sec + 1e-9 * (ended.tv_nsec - began.tv_nsec));
    }
    printf("], \"rows\": [");
    for (int i = 0; i <= ROWS; i++)
        printf("%s%ld", i ? ", " : "", had[i]);
    printf("], \"final\": [%.17g, %.17g, %.17g, %.17g]}\n", q[0].x, q[1].x, q[2].x, q[3].x);
    return 0;
}
