/* Spring forces of a mesh in C, in the layouts that are known to be good: what the pass of the rig is measured beside.
 *
 * Reads a mesh (argument 1; see `dump` in rivals.rs) and prints a line per layout: its name, the shortest single pass
 * within the milliseconds of argument 2 in ns per edge, and the largest difference from a plain sum in double, over
 * the largest force. The stiffness of all edges is 1, as in the rig's own pass; that one also lets edges go slack.
 */
#define _GNU_SOURCE
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#ifdef __x86_64__
#include <immintrin.h>
#endif

enum { LANES = 16 };

/* As given: places in rows of four floats, edges, lengths at rest. */
static uint32_t nodes, edges;
static float *place4, *force4;
static uint32_t (*ends)[2];
static float *rest;

/* By coordinate, padded to whole blocks of sixteen. */
static uint32_t blocks;
static float *place[3], *force[3];

/* Of block b, rows first_row[b] to first_row[b + 1]: one neighbour of each of its nodes. */
struct row {
    uint32_t other[LANES];
    float rest[LANES];
};
static uint32_t *first_row;
static struct row *rows;

static void fail(const char *why)
{
    fprintf(stderr, "%s\n", why);
    exit(1);
}

static void *room(size_t bytes)
{
    size_t whole = (bytes + 127) / 64 * 64;
    void *new = aligned_alloc(64, whole);
    if (!new)
        fail("no memory");
    return memset(new, 0, whole);
}

static void read_all(void *to, size_t bytes, FILE *from)
{
    if (fread(to, 1, bytes, from) != bytes)
        fail("the mesh ends early");
}

static void read_mesh(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        fail("cannot open the mesh");
    read_all(&nodes, 4, file);
    read_all(&edges, 4, file);
    blocks = (nodes + LANES - 1) / LANES;
    place4 = room(16ul * nodes);
    force4 = room(16ul * nodes);
    ends = room(8ul * edges);
    rest = room(4ul * edges);
    for (uint32_t v = 0; v < nodes; v++)
        read_all(place4 + 4ul * v, 12, file);
    read_all(ends, 8ul * edges, file);
    read_all(rest, 4ul * edges, file);
    fclose(file);
}

static void lay_out(void)
{
    for (int axis = 0; axis < 3; axis++) {
        place[axis] = room(4ul * LANES * blocks);
        force[axis] = room(4ul * LANES * blocks);
        for (uint32_t v = 0; v < nodes; v++)
            place[axis][v] = place4[4ul * v + axis];
    }
    uint32_t *degree = room(4ul * LANES * blocks);
    for (uint32_t e = 0; e < edges; e++) {
        degree[ends[e][0]]++;
        degree[ends[e][1]]++;
    }
    first_row = room(4ul * (blocks + 1));
    for (uint32_t b = 0; b < blocks; b++) {
        uint32_t height = 0;
        for (int l = 0; l < LANES; l++)
            if (degree[b * LANES + l] > height)
                height = degree[b * LANES + l];
        first_row[b + 1] = first_row[b] + height;
    }
    rows = room(sizeof *rows * first_row[blocks]);
    for (uint32_t b = 0; b < blocks; b++)
        for (uint32_t r = first_row[b]; r < first_row[b + 1]; r++)
            for (uint32_t l = 0; l < LANES; l++)
                rows[r].other[l] = b * LANES + l < nodes ? b * LANES + l : 0;
    memset(degree, 0, 4ul * LANES * blocks);
    for (uint32_t e = 0; e < edges; e++)
        for (int end = 0; end < 2; end++) {
            uint32_t v = ends[e][end];
            struct row *row = rows + first_row[v / LANES] + degree[v]++;
            row->other[v % LANES] = ends[e][1 - end];
            row->rest[v % LANES] = rest[e];
        }
    free(degree);
}

/* Each edge once, its force added at both ends. */
static void scatter(void)
{
    memset(force4, 0, 16ul * nodes);
#ifdef __SSE4_1__
    for (uint32_t e = 0; e < edges; e++) {
        float *at = force4 + 4ul * ends[e][0], *to = force4 + 4ul * ends[e][1];
        __m128 way = _mm_sub_ps(_mm_load_ps(place4 + 4ul * ends[e][1]), _mm_load_ps(place4 + 4ul * ends[e][0]));
        __m128 length = _mm_sqrt_ps(_mm_dp_ps(way, way, 0x7f));
        __m128 pull = _mm_sub_ps(way, _mm_mul_ps(way, _mm_div_ps(_mm_set1_ps(rest[e]), length)));
        _mm_store_ps(at, _mm_add_ps(_mm_load_ps(at), pull));
        _mm_store_ps(to, _mm_sub_ps(_mm_load_ps(to), pull));
    }
#else
    for (uint32_t e = 0; e < edges; e++) {
        const float *a = place4 + 4ul * ends[e][0], *b = place4 + 4ul * ends[e][1];
        float *at = force4 + 4ul * ends[e][0], *to = force4 + 4ul * ends[e][1];
        float x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
        float strain = 1 - rest[e] / sqrtf(x * x + y * y + z * z);
        at[0] += strain * x, at[1] += strain * y, at[2] += strain * z;
        to[0] -= strain * x, to[1] -= strain * y, to[2] -= strain * z;
    }
#endif
}

/* Each node's neighbours in turn, sixteen nodes at once: what the compiler makes of it. */
static void gather(void)
{
    const float *restrict px = place[0], *restrict py = place[1], *restrict pz = place[2];
    for (uint32_t b = 0; b < blocks; b++) {
        float sum[3][LANES] = {{0}};
        size_t own = (size_t)b * LANES;
        for (uint32_t r = first_row[b]; r < first_row[b + 1]; r++)
            for (int l = 0; l < LANES; l++) {
                uint32_t other = rows[r].other[l];
                float x = px[other] - px[own + l], y = py[other] - py[own + l], z = pz[other] - pz[own + l];
                float strain = 1 - rows[r].rest[l] / sqrtf(x * x + y * y + z * z + 1e-20f);
                sum[0][l] += strain * x;
                sum[1][l] += strain * y;
                sum[2][l] += strain * z;
            }
        for (int axis = 0; axis < 3; axis++)
            memcpy(force[axis] + own, sum[axis], sizeof sum[axis]);
    }
}

#ifdef __AVX512F__
static inline __m512 strain512(__m512 x, __m512 y, __m512 z, __m512 rest_length)
{
    __m512 square = _mm512_fmadd_ps(x, x, _mm512_set1_ps(1e-20f));
    square = _mm512_fmadd_ps(z, z, _mm512_fmadd_ps(y, y, square));
    /* One step of Newton's makes the estimate as good as a float. */
    __m512 root = _mm512_rsqrt14_ps(square);
    __m512 half = _mm512_mul_ps(_mm512_mul_ps(square, _mm512_set1_ps(0.5f)), root);
    root = _mm512_mul_ps(root, _mm512_fnmadd_ps(half, root, _mm512_set1_ps(1.5f)));
    return _mm512_fnmadd_ps(rest_length, root, _mm512_set1_ps(1));
}

/* The same with the instructions named: three gathers per row. */
static void gather_by_hand(void)
{
    for (uint32_t b = 0; b < blocks; b++) {
        size_t own = (size_t)b * LANES;
        __m512 at[3], sum[3];
        for (int axis = 0; axis < 3; axis++) {
            at[axis] = _mm512_load_ps(place[axis] + own);
            sum[axis] = _mm512_setzero_ps();
        }
        for (uint32_t r = first_row[b]; r < first_row[b + 1]; r++) {
            __m512i other = _mm512_load_si512(rows[r].other);
            __m512 way[3];
            for (int axis = 0; axis < 3; axis++)
                way[axis] = _mm512_sub_ps(_mm512_i32gather_ps(other, place[axis], 4), at[axis]);
            __m512 strain = strain512(way[0], way[1], way[2], _mm512_load_ps(rows[r].rest));
            for (int axis = 0; axis < 3; axis++)
                sum[axis] = _mm512_fmadd_ps(strain, way[axis], sum[axis]);
        }
        for (int axis = 0; axis < 3; axis++)
            _mm512_store_ps(force[axis] + own, sum[axis]);
    }
}

/* Four nodes, one to each quarter of a vector. */
static inline __m512 four(const uint32_t *node)
{
    __m512 all = _mm512_castps128_ps512(_mm_load_ps(place4 + 4ul * node[0]));
    all = _mm512_insertf32x4(all, _mm_load_ps(place4 + 4ul * node[4]), 1);
    all = _mm512_insertf32x4(all, _mm_load_ps(place4 + 4ul * node[8]), 2);
    return _mm512_insertf32x4(all, _mm_load_ps(place4 + 4ul * node[12]), 3);
}

/* The rig's own idea in C: a load per neighbour, sixteen of them turned into x, y and z. */
static void loads(void)
{
    for (uint32_t b = 0; b < blocks; b++) {
        size_t own = (size_t)b * LANES;
        __m512 sum[3] = {_mm512_setzero_ps(), _mm512_setzero_ps(), _mm512_setzero_ps()};
        for (uint32_t r = first_row[b]; r < first_row[b + 1]; r++) {
            const uint32_t *other = rows[r].other;
            __m512 n0 = four(other), n1 = four(other + 1), n2 = four(other + 2), n3 = four(other + 3);
            __m512d xy0 = _mm512_castps_pd(_mm512_unpacklo_ps(n0, n1)), xy2 = _mm512_castps_pd(_mm512_unpacklo_ps(n2, n3));
            __m512d z0 = _mm512_castps_pd(_mm512_unpackhi_ps(n0, n1)), z2 = _mm512_castps_pd(_mm512_unpackhi_ps(n2, n3));
            __m512 x = _mm512_castpd_ps(_mm512_unpacklo_pd(xy0, xy2)), y = _mm512_castpd_ps(_mm512_unpackhi_pd(xy0, xy2));
            __m512 z = _mm512_castpd_ps(_mm512_unpacklo_pd(z0, z2));
            x = _mm512_sub_ps(x, _mm512_load_ps(place[0] + own));
            y = _mm512_sub_ps(y, _mm512_load_ps(place[1] + own));
            z = _mm512_sub_ps(z, _mm512_load_ps(place[2] + own));
            __m512 strain = strain512(x, y, z, _mm512_load_ps(rows[r].rest));
            sum[0] = _mm512_fmadd_ps(strain, x, sum[0]);
            sum[1] = _mm512_fmadd_ps(strain, y, sum[1]);
            sum[2] = _mm512_fmadd_ps(strain, z, sum[2]);
        }
        for (int axis = 0; axis < 3; axis++)
            _mm512_store_ps(force[axis] + own, sum[axis]);
    }
}
#endif

static double now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

/* The largest difference of the forces from a plain sum, over the largest force. */
static double difference(int in_rows)
{
    double (*plain)[3] = room(24ul * nodes), worst = 0, largest = 1e-30;
    for (uint32_t e = 0; e < edges; e++) {
        double way[3], square = 0;
        for (int axis = 0; axis < 3; axis++) {
            way[axis] = (double)place4[4ul * ends[e][1] + axis] - (double)place4[4ul * ends[e][0] + axis];
            square += way[axis] * way[axis];
        }
        double strain = 1 - rest[e] / sqrt(square);
        for (int axis = 0; axis < 3; axis++) {
            plain[ends[e][0]][axis] += strain * way[axis];
            plain[ends[e][1]][axis] -= strain * way[axis];
        }
    }
    for (uint32_t v = 0; v < nodes; v++)
        for (int axis = 0; axis < 3; axis++) {
            double found = in_rows ? force4[4ul * v + axis] : force[axis][v];
            worst = fmax(worst, fabs(found - plain[v][axis]));
            largest = fmax(largest, fabs(plain[v][axis]));
        }
    free(plain);
    return worst / largest;
}

static void measure(const char *name, void (*pass)(void), int in_rows, double ms)
{
    double shortest = INFINITY, begin = now_ns();
    while (now_ns() - begin < 1e6 * ms) {
        double start = now_ns();
        pass();
        shortest = fmin(shortest, now_ns() - start);
    }
    printf("%s\t%.6f\t%.3e\n", name, shortest / edges, difference(in_rows));
}

int main(int count, char **words)
{
    if (count != 3)
        fail("usage: springs MESH MILLISECONDS");
    read_mesh(words[1]);
    lay_out();
    double ms = atof(words[2]);
    measure("C, scatter, 4-float nodes", scatter, 1, ms);
    measure("C, ELL gather, auto-vectorised", gather, 0, ms);
#ifdef __AVX512F__
    measure("C, ELL gather, AVX-512", gather_by_hand, 0, ms);
    measure("C, our layout, AVX-512", loads, 0, ms);
#endif
    return 0;
}
