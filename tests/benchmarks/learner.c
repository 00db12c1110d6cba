/* The same work as upswing's loop, written straightforwardly: full control, every step recorded.

   -DREAL=float or double   the numbers of the networks (the pendulum and the table are double)
   -DFIRST=… -DSECOND=…     sizes of the hidden layers; FIRST=0 is a table, SECOND=0 one hidden layer
   Usage: learner STEPS SEED STEP_SIZE; prints nanoseconds a step, and a number that needs the results. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define ANGLES 8
#define VELOCITIES 20
#define TILES (ANGLES * VELOCITIES)
#define ACTIONS 3
#define ONE(n) ((n) > 0 ? (n) : 1)

static const double ACCELERATION[ACTIONS] = {-10, 0, 10};
static const double M = 0.1, L = 0.2, G = 9.81, FRICTION = 0.001, DT = 0.005, PI = 3.14159265358979323846;

static uint64_t state;
static double uniform(void) { /* xorshift */
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (state >> 11) * 0x1.0p-53;
}

#if FIRST == 0
static double q_table[TILES][ACTIONS];
static void values(int tile, int which, double *q) {
    (void)which;
    for (int a = 0; a < ACTIONS; a++) q[a] = q_table[tile][a];
}
static void update(int tile, int action, double error) { q_table[tile][action] += error; }
static void begin(void) {}
#else
static REAL w[ACTIONS][TILES][FIRST], u[ACTIONS][ONE(SECOND)][FIRST], v[ACTIONS][SECOND ? ONE(SECOND) : FIRST];
/* activations of this state (0) and of the next (1) */
static REAL h_[2][ACTIONS][FIRST], g_[2][ACTIONS][ONE(SECOND)];
static inline REAL logistic(REAL x) { return 1 / (1 + (sizeof(REAL) == 4 ? expf(-x) : exp(-x))); }
static inline __attribute__((always_inline)) void forward(int a, int tile, int which, double *q) {
    REAL (*h)[FIRST] = h_[which], (*g)[ONE(SECOND)] = g_[which], sum = 0;
    (void)g;
    for (int j = 0; j < FIRST; j++) h[a][j] = logistic(w[a][tile][j]);
#if SECOND
    for (int k = 0; k < SECOND; k++) {
        REAL potential = 0;
        for (int j = 0; j < FIRST; j++) potential += u[a][k][j] * h[a][j];
        g[a][k] = logistic(potential);
        sum += v[a][k] * g[a][k];
    }
#else
    for (int j = 0; j < FIRST; j++) sum += v[a][j] * h[a][j];
#endif
    *q = sum;
}
static inline __attribute__((always_inline)) void values(int tile, int which, double *q) {
    for (int a = 0; a < ACTIONS; a++) forward(a, tile, which, &q[a]);
}
static void update(int tile, int a, double error) {
    REAL (*h)[FIRST] = h_[0], (*g)[ONE(SECOND)] = g_[0], change = 0.1 * error;
    (void)g;
#if SECOND
    REAL back[FIRST] = {0};
    for (int k = 0; k < SECOND; k++) {
        REAL second = change * v[a][k] * g[a][k] * (1 - g[a][k]);
        v[a][k] += change * g[a][k];
        for (int j = 0; j < FIRST; j++) {
            back[j] += u[a][k][j] * second;
            u[a][k][j] += second * h[a][j];
        }
    }
    for (int j = 0; j < FIRST; j++) w[a][tile][j] += back[j] * h[a][j] * (1 - h[a][j]);
#else
    for (int j = 0; j < FIRST; j++) {
        REAL hidden = change * v[a][j] * h[a][j] * (1 - h[a][j]);
        v[a][j] += change * h[a][j];
        w[a][tile][j] += hidden;
    }
#endif
}
static void begin(void) {
    for (size_t i = 0; i < sizeof w / sizeof(REAL); i++) ((REAL *)w)[i] = 2 * uniform() - 1;
    for (size_t i = 0; i < sizeof u / sizeof(REAL); i++) ((REAL *)u)[i] = 2 * uniform() - 1;
    for (size_t i = 0; i < sizeof v / sizeof(REAL); i++) ((REAL *)v)[i] = 2 * uniform() - 1;
}
#endif

static int locate(double angle, double velocity) {
    int row = floor((angle + PI) / (2 * PI) * ANGLES), column = floor((velocity + 20) / 40 * VELOCITIES);
    row = row < 0 ? 0 : row >= ANGLES ? ANGLES - 1 : row;
    column = column < 0 ? 0 : column >= VELOCITIES ? VELOCITIES - 1 : column;
    return row * VELOCITIES + column;
}

struct step { float angle, velocity, position, cart_velocity, reward, td_error; int8_t action; };

int main(int count, char **arguments) {
    if (count != 4) return 2;
    long steps = atol(arguments[1]);
    state = 88172645463325252ull + strtoull(arguments[2], 0, 10) * 7919;
    double step_size = atof(arguments[3]);
    struct step *run = calloc(steps, sizeof *run);
    if (!run) return 1;
    begin();
    double angle = (2 * uniform() - 1) * PI, velocity = 0, position = 0, cart = 0;
    int tile = locate(angle, velocity);
    struct timespec from, to;
    clock_gettime(CLOCK_MONOTONIC, &from);
    for (long t = 0; t < steps; t++) {
        double q[ACTIONS], next[ACTIONS];
        values(tile, 0, q);
        int action = 0;
        if (uniform() < 0.01) action = (int)(uniform() * ACTIONS);
        else {
            int best[ACTIONS], ties = 0;
            double most = fmax(q[0], fmax(q[1], q[2]));
            for (int a = 0; a < ACTIONS; a++)
                if (q[a] == most) best[ties++] = a;
            action = ties == 1 ? best[0] : best[(int)(uniform() * ties)];
        }
        double x = ACCELERATION[action];
        double torque = M * G * L / 2 * sin(angle) + M * L / 2 * x * cos(angle) - FRICTION * velocity;
        double acceleration = torque / (M * L * L / 3);
        double next_angle = angle + velocity * DT + acceleration * DT * DT;
        double next_velocity = velocity + acceleration * DT;
        double next_position = position + cart * DT + x * DT * DT, next_cart = cart + x * DT;
        next_angle -= 2 * PI * floor((next_angle + PI) / (2 * PI));
        double reward = -next_angle * next_angle;
        int next_tile = locate(next_angle, next_velocity);
        values(next_tile, 1, next);
        double td_error = 4 * reward + 0.7 * fmax(next[0], fmax(next[1], next[2])) - q[action];
        update(tile, action, step_size * td_error);
        run[t] = (struct step){angle, velocity, position, cart, reward, td_error / 4, action};
        angle = next_angle, velocity = next_velocity, position = next_position, cart = next_cart, tile = next_tile;
    }
    clock_gettime(CLOCK_MONOTONIC, &to);
    double sum = 0;
    for (long t = 0; t < steps; t++) sum += run[t].angle;
    printf("%.3f %g\n", ((to.tv_sec - from.tv_sec) * 1e9 + (to.tv_nsec - from.tv_nsec)) / steps, sum);
    return 0;
}
