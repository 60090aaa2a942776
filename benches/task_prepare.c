/* task_prepare.c: what a contact costs before the first call. */
#include "measure.h"
#include "tasks.h"

#include <math.h>
#include <stdlib.h>

static double microslip(void *context)
{
    mslip_contact contact;
    mslip_contact_init(context, &contact);
    return contact.slip_displacement;
}

static double closed_form(void *context)
{
    return law_of(context).slip_displacement;
}

typedef struct { const mslip_contact *contact; size_t n; double stiffness[4096], slip[4096]; } bank;

static double sliders_fitted(void *context)
{
    bank *b = context;
    double error;
    mslip_iwan_equivalent(b->contact, b->n, b->stiffness, b->slip, &error);
    return error;
}

static double error_of(double displacement, const subject *s)
{
    return fabs(displacement / reference_slip_displacement(s->truth) - 1.0);
}

void task_prepare(const subject *s)
{
    const size_t first = entry_count;
    entry_add("prepare", "microslip", microslip, (void *)&s->parameters, 1)->error =
        error_of(s->contact.slip_displacement, s);
    entry_add("prepare", "closed form by Newton", closed_form, (void *)&s->parameters, 1)->error =
        error_of(s->law.slip_displacement, s);
    for (size_t n = 16; n <= 256; n *= 4) {
        bank *b = context_of(sizeof *b);
        b->contact = &s->contact;
        b->n = n;
        /* The fit is microslip's own: its largest error over mu N. */
        const double error = sliders_fitted(b);
        entry *e = entry_add("prepare", "sliders", sliders_fitted, b, 1);
        e->parameter = (double)n;
        e->error = error;
    }
    for (size_t i = first; i < entry_count; ++i) {
        entries[i].shape = s->shape;
    }
    measure(first);
}
