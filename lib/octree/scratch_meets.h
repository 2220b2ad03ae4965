/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef SCRATCH_MEETS_H
#define SCRATCH_MEETS_H
#include "../geom/vector.h"
#include "../surface/surface.h"
static inline bool scratch_meets(const tm_surface *S, uint32_t t, const double low[3],
                                 const double high[3])
{
    double v[3][3], h[3], scale = 0;
    for (int i = 0; i < 3; i++) {
        const double c = (low[i] + high[i]) / 2;
        h[i] = (high[i] - low[i]) / 2;
        scale = fmax(scale, fmax(fabs(low[i]), fabs(high[i])));
        for (int k = 0; k < 3; k++)
            v[k][i] = S->xyz[S->triangle[t][k]][i] - c;
    }
    const double eps = 1e-14 * scale;
    for (int i = 0; i < 3; i++) {
        h[i] += eps;
        const double lo = fmin(v[0][i], fmin(v[1][i], v[2][i]));
        const double hi = fmax(v[0][i], fmax(v[1][i], v[2][i]));
        if (lo > h[i] || hi < -h[i])
            return false;
    }
    double e[3][3], n[3];
    for (int k = 0; k < 3; k++)
        tm_subtract(e[k], v[(k + 1) % 3], v[k]);
    tm_cross(n, e[0], e[1]);
    if (fabs(tm_dot(n, v[0])) > fabs(n[0]) * h[0] + fabs(n[1]) * h[1] + fabs(n[2]) * h[2])
        return false;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) {
            const int a = (i + 1) % 3, b = (i + 2) % 3;
            const double p = e[k][a] * v[k][b] - e[k][b] * v[k][a];
            const double q = e[k][a] * v[(k + 2) % 3][b] - e[k][b] * v[(k + 2) % 3][a];
            const double r = fabs(e[k][a]) * h[b] + fabs(e[k][b]) * h[a];
            if (fmin(p, q) > r || fmax(p, q) < -r)
                return false;
        }
    return true;
}
#ifdef SCRATCH_SURFACE
size_t tm_surface_cull(const tm_surface *S, const uint32_t *from, size_t n, const double low[3],
                                  const double high[3], uint32_t *to);
size_t tm_surface_cull(const tm_surface *S, const uint32_t *from, size_t n, const double low[3],
                                  const double high[3], uint32_t *to)
{
    size_t k = 0;
    for (size_t i = 0; i < n; i++)
        if (scratch_meets(S, from[i], low, high))
            to[k++] = from[i];
    return k;
}
#ifdef SCRATCH_BUILD
#include <stdlib.h>
#include <string.h>
typedef struct tm_surface_options {
    double feature_angle; /* an edge is sharp where its normals differ by more: degrees */
    bool lenient;         /* open surfaces, and such that cross themselves, are taken */
} tm_surface_options;
static tm_status tm_surface_build(tm_surface *S, const tm_polygon_surface *P, const tm_surface_options *o, tm_error *e)
{ (void)o;(void)e; *S=(tm_surface){.nodes=P->nodes,.triangles=P->polygons};
 S->xyz=malloc(24*P->nodes+1);memcpy(S->xyz,P->xyz,24*P->nodes);S->triangle=malloc(12*P->polygons+1);memcpy(S->triangle,P->item,12*P->polygons);
 for(int i=0;i<3;i++){S->low[i]=1e300;S->high[i]=-1e300;for(size_t n=0;n<S->nodes;n++){if(S->xyz[n][i]<S->low[i])S->low[i]=S->xyz[n][i];if(S->xyz[n][i]>S->high[i])S->high[i]=S->xyz[n][i];}}
 return TM_OK; }
static void tm_surface_free(tm_surface *S){free(S->xyz);free(S->triangle);}
#endif
bool tm_surface_meets_box(const tm_surface *s, const double l[3], const double h[3]){
 for (uint32_t t=0;t<s->triangles;t++) if (scratch_meets(s,t,l,h)) return true;
 return false;}
bool tm_surface_has_inside(const tm_surface *s, const double p[3]){
  double w=0; /* solid angles */
  for (uint32_t t=0;t<s->triangles;t++){ double a[3],b[3],c[3],n[3];
   tm_subtract(a,s->xyz[s->triangle[t][0]],p);tm_subtract(b,s->xyz[s->triangle[t][1]],p);tm_subtract(c,s->xyz[s->triangle[t][2]],p);
   tm_cross(n,b,c); double A=tm_norm(a),B=tm_norm(b),C=tm_norm(c);
   w+=2*atan2(tm_dot(a,n),A*B*C+tm_dot(a,b)*C+tm_dot(b,c)*A+tm_dot(c,a)*B);}
  return w>6.283185307;
}
#endif
#endif
