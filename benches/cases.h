/* cases.h: the contacts and the motions. */
#ifndef CASES_H
#define CASES_H

#include "law.h"
#include "reference.h"
#include "sliders.h"

enum { SHAPES = 4, AMPLITUDES = 4, ORDERS = 3, BANKS = 7 };
extern const double shapes[SHAPES];         /* a/b, from the cylinder to nearly flat */
extern const double amplitudes[AMPLITUDES]; /* over the displacement of gross slip */
extern const int orders[ORDERS];            /* harmonics */

/* A steel contact of half-width 0.5 mm under 800 N, and all that competitors derive from it. */
typedef struct subject {
    double shape;
    mslip_parameters parameters;
    mslip_contact contact;
    law law;
    reference *truth;
    sliders bank[BANKS]; /* of 1, 4, 16, ... sliders: the best there are for the contact */
    sliders even[BANKS]; /* as many, at equal steps of the displacement, as banks are made by hand */
} subject;

mslip_parameters parameters_of(double shape);
subject subject_of(double shape, int most_sliders);
void subject_free(subject *s);

/* Its bank of n = 1, 4, 16, ... sliders; one slider: initial stiffness and slip force. */
const sliders *bank_of(const subject *s, int n);
const sliders *even_bank_of(const subject *s, int n);
/* The slider with the contact's K' and K'' at an amplitude. */
sliders jenkins_of(const subject *s, double amplitude);

/* Coefficients [c0, cos1, sin1, ...] of a motion with half the range `size`, its highest point a third of a step
   away from a sample whenever the number of samples is a power of two. */
void motion_of(int harmonics, double size, double *coefficients);

void succeed(int32_t status); /* or name the status and exit */

#endif
