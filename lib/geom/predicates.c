/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "predicates.h"

/* A point seen from the one that is tested, with its squared distance. */
typedef struct lifted {
    double x, y, z;
    double square;
} lifted;

static inline lifted lift(const double point[3], const double origin[3])
{
    const double x = point[0] - origin[0];
    const double y = point[1] - origin[1];
    const double z = point[2] - origin[2];
    return (lifted){x, y, z, x * x + y * y + z * z};
}

/* A 2×2 determinant of x and y, and the sum of its products' absolute values. */
typedef struct minor {
    double value;
    double permanent;
} minor;

static inline minor minor2(lifted p, lifted q)
{
    const double left = p.x * q.y;
    const double right = q.x * p.y;
    return (minor){left - right, fabs(left) + fabs(right)};
}

/* det(p, q, r), expanded by z, from the minors qr, rp, pq. */
static inline minor minor3(lifted p, lifted q, lifted r, minor qr, minor rp, minor pq)
{
    return (minor){p.z * qr.value + q.z * rp.value + r.z * pq.value,
                   fabs(p.z) * qr.permanent + fabs(q.z) * rp.permanent +
                       fabs(r.z) * pq.permanent};
}

static inline minor negative(minor m)
{
    return (minor){-m.value, m.permanent};
}

/* Error: Shewchuk's (16 + 224ε)ε times the permanent (his isperrboundA). Underflow: let
 * no difference be larger than m. Then a square loses 3u, a 3×3 minor (at most 6m³)
 * 6um + 3u, so that the four products square · minor lose 4 (18um³ + 3m²(6um + 3u) + u),
 * which is below 200u (1 + m³) ≤ 400u (1 + s)² with s the sum of the squares. */
int tm_insphere(const double a[3], const double b[3], const double c[3],
                const double d[3], const double e[3])
{
    const double relative_error = (16 + 224 * TM_HALF_ULP) * TM_HALF_ULP;
    const lifted pa = lift(a, e);
    const lifted pb = lift(b, e);
    const lifted pc = lift(c, e);
    const lifted pd = lift(d, e);

    const minor ab = minor2(pa, pb);
    const minor bc = minor2(pb, pc);
    const minor cd = minor2(pc, pd);
    const minor da = minor2(pd, pa);
    const minor ac = minor2(pa, pc);
    const minor bd = minor2(pb, pd);

    const minor abc = minor3(pa, pb, pc, bc, negative(ac), ab);
    const minor bcd = minor3(pb, pc, pd, cd, negative(bd), bc);
    const minor cda = minor3(pc, pd, pa, da, ac, cd);
    const minor dab = minor3(pd, pa, pb, ab, bd, da);

    const double determinant = (pa.square * bcd.value - pb.square * cda.value) +
                               (pc.square * dab.value - pd.square * abc.value);
    const double permanent = pa.square * bcd.permanent + pb.square * cda.permanent +
                             pc.square * dab.permanent + pd.square * abc.permanent;
    const double squares = 1 + pa.square + pb.square + pc.square + pd.square;
    const double bound = relative_error * permanent + TM_UNDERFLOW * squares * squares;
    if (determinant > bound)
        return 1;
    if (determinant < -bound)
        return -1;
    return tm_insphere_exact(a, b, c, d, e);
}
