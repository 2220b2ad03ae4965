/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small solids of few polygons that are sharp or thin. */
#ifndef TM_SHAPES_SOLIDS_H
#define TM_SHAPES_SOLIDS_H

#include "surface.h"

/* A cube of side 1/4 with a pyramid on each face. */
void make_star(surface *s);

/* A cube, its top cut down by an angle that gets narrower below. */
void make_slit(surface *s);

/* A pyramid of seven sides, eight times as high as its base is wide. */
void make_spike(surface *s);

/* A prism over a triangle with an angle of 1°. */
void make_wedge(surface *s);

/* A prism over a step whose riser leans over. */
void make_step(surface *s);

/* Two discs on a thin axle. */
void make_spool(surface *s);

#endif
