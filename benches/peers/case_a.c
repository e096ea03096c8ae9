/* The explicit scheme as a plain loop: predict, the gaps of all blades from
 * their sines and cosines, correct those below zero so that contact only
 * pushes. Four coordinates, machine of the paper, three nodal diameters,
 * 500 rad/s.
 *
 *   case_a STEP_S END_S PULSE_N ZETA_C SKIP REPEATS
 *
 * SKIP 1 leaves the blades out while the casing is displaced by less than the
 * clearance. Prints JSON: processor seconds of each repeat, impacts, final state. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { BLADES = 22, DIAMETERS = 3, ROWS = 4, MOST = 64 };

struct coordinate { double x, step, keep, compliance, stiffness; };

static struct coordinate coordinate(double mass, double stiffness, double zeta, double h)
{
    double inertia = mass / (h * h), drag = zeta * sqrt(mass * stiffness) / h;
    return (struct coordinate){0, 0, (inertia - drag) / (inertia + drag), 1 / (inertia + drag), stiffness};
}

static void predict(struct coordinate *c, double force)
{
    c->step = c->keep * c->step + c->compliance * (force - c->stiffness * c->x);
    c->x += c->step;
}

/* Integral of the pulse over the step around step n, as a mean force. */
static double pulse(long n, double h, double force, double length)
{
    double from = fmax(n * h - h / 2, 0), to = fmin(n * h + h / 2, length);
    return n == 0 ? force : from < to ? force * (to - from) / h : 0;
}

struct row { int blade; double gap, c[4], lambda; };

static void correct(struct row *row, int rows, struct coordinate q[4])
{
    double w[ROWS][ROWS];
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < rows; j++) {
            w[i][j] = 0;
            for (int k = 0; k < 4; k++)
                w[i][j] += row[i].c[k] * q[k].compliance * row[j].c[k];
        }
    /* Pushes are negative: g = g* - w lambda. Projected Gauss-Seidel, until nothing changes. */
    for (int sweep = 0; sweep < 10000; sweep++) {
        double change = 0;
        for (int i = 0; i < rows; i++) {
            double gap = row[i].gap;
            for (int j = 0; j < rows; j++)
                gap -= w[i][j] * row[j].lambda;
            double next = fmin(row[i].lambda + gap / w[i][i], 0);
            change = fmax(change, fabs(next - row[i].lambda) / (fabs(next) + 1e-300));
            row[i].lambda = next;
        }
        if (change < 1e-15)
            break;
    }
    for (int i = 0; i < rows; i++)
        for (int k = 0; k < 4; k++) {
            double by = -q[k].compliance * row[i].c[k] * row[i].lambda;
            q[k].x += by;
            q[k].step += by;
        }
}

int main(int argc, char **argv)
{
    if (argc != 7)
        return 2;
    double h = atof(argv[1]), end = atof(argv[2]), force = atof(argv[3]), zeta = atof(argv[4]);
    int skip = atoi(argv[5]), repeats = atoi(argv[6]);
    const double turn = 2 * acos(-1), g0 = 0.5 - 0.4999, speed = 500, length = 50e-6;
    const double inertia = 0.20825 * BLADES / 2;
    const double stiffness = BLADES / 2 * (15000 + 6000 * (1 - cos(turn * DIAMETERS / BLADES)));
    double phase[BLADES], cosine[BLADES], sine[BLADES];
    for (int i = 0; i < BLADES; i++) {
        phase[i] = turn * (DIAMETERS * i % BLADES) / BLADES;
        cosine[i] = cos(phase[i]);
        sine[i] = sin(phase[i]);
    }
    long steps = lround(end / h);
    printf("{\"steps\": %ld, \"seconds\": [", steps);
    struct { double t; int blade; } impact[MOST];
    int impacts = 0;
    struct coordinate q[4];
    for (int repeat = 0; repeat < repeats; repeat++) {
        struct timespec began, ended;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &began);
        long touched[BLADES] = {0};
        impacts = 0;
        for (int k = 0; k < 4; k++)
            q[k] = k < 2 ? coordinate(2, 1.544e6, zeta, h) : coordinate(inertia, stiffness, 0.04, h);
        q[0].step = -h * h * force / 4; /* x[-1] = h^2/2 a */
        for (long n = 0; n < steps; n++) {
            for (int k = 0; k < 4; k++)
                predict(&q[k], k == 0 ? pulse(n, h, force, length) : 0);
            if (skip && q[0].x * q[0].x + q[1].x * q[1].x < g0 * g0)
                continue;
            double angle = DIAMETERS * speed * (n + 1) * h;
            struct row row[ROWS];
            int rows = 0;
            for (int i = 0; i < BLADES; i++) {
                double alpha = cosine[i] * q[2].x + sine[i] * q[3].x;
                double beta = angle + phase[i] + DIAMETERS * alpha;
                double c = cos(beta), s = sin(beta), gap = g0 + q[0].x * c + q[1].x * s;
                if (gap >= 0)
                    continue;
                if (rows == ROWS)
                    return 1;
                double lever = DIAMETERS * (q[1].x * c - q[0].x * s);
                row[rows++] = (struct row){i, gap, {c, s, lever * cosine[i], lever * sine[i]}, 0};
            }
            if (rows == 0)
                continue;
            correct(row, rows, q);
            for (int i = 0; i < rows; i++) {
                if (row[i].lambda == 0)
                    continue;
                long *last = &touched[row[i].blade];
                if ((*last == 0 || n + 1 - *last > 2) && impacts < MOST) {
                    impact[impacts].t = (n + 1) * h;
                    impact[impacts++].blade = row[i].blade + 1;
                }
                *last = n + 1;
            }
        }
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &ended);
        printf("%s%.9f", repeat ? ", " : "",
               ended.tv_sec - began.tv_sec + 1e-9 * (ended.tv_nsec - began.tv_nsec));
    }
    printf("], \"impacts\": [");
    for (int i = 0; i < impacts; i++)
        printf("%s[%.12g, %d]", i ? ", " : "", impact[i].t, impact[i].blade);
    printf("], \"u_m\": [%.17g, %.17g]}\n", q[0].x, q[1].x);
    return 0;
}
