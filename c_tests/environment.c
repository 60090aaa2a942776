/* The floating-point environment of the caller: four directions of rounding, subnormal numbers flushed, flags raised already. No
   call hangs, raises what may be trapped, answers by another status or changes the environment, and every number is near
   the one of the usual environment. */
#include "bad_calls.h"

#if defined(__SSE2__) && (defined(__GNUC__) || defined(__clang__))
#include <xmmintrin.h>
#define HAS_FLUSHING 1
#else
#define HAS_FLUSHING 0
#endif

/* Bits of MXCSR: subnormal inputs are zeros, subnormal results are zeros, all of its flags. */
enum { DENORMALS_ARE_ZERO = 0x40, FLUSH_TO_ZERO = 0x8000, FLAGS = 0x3f };

static const struct {
    const char *name;
    int rounding;
    unsigned flushing;
} environments[] = {
    { "to nearest", FE_TONEAREST, 0 },
    { "upward", FE_UPWARD, 0 },
    { "downward", FE_DOWNWARD, 0 },
    { "toward zero", FE_TOWARDZERO, 0 },
#if HAS_FLUSHING
    { "results flushed", FE_TONEAREST, FLUSH_TO_ZERO },
    { "inputs flushed", FE_TONEAREST, DENORMALS_ARE_ZERO },
    { "flushed", FE_TONEAREST, FLUSH_TO_ZERO | DENORMALS_ARE_ZERO },
    { "flushed, upward", FE_UPWARD, FLUSH_TO_ZERO | DENORMALS_ARE_ZERO },
    { "flushed, downward", FE_DOWNWARD, FLUSH_TO_ZERO | DENORMALS_ARE_ZERO },
#endif
};
enum { ENVIRONMENTS = sizeof environments / sizeof *environments };

static unsigned control_bits(void)
{
#if HAS_FLUSHING
    return _mm_getcsr() & ~(unsigned)FLAGS;
#else
    return 0;
#endif
}

static void enter(int environment)
{
    fesetround(environments[environment].rounding);
#if HAS_FLUSHING
    _mm_setcsr((_mm_getcsr() & ~(unsigned)(FLUSH_TO_ZERO | DENORMALS_ARE_ZERO)) | environments[environment].flushing);
#endif
}

/* Contacts of every kind, each prepared in the environment. */
enum { CONTACTS = 8 };
static int32_t make_contact(int kind, mslip_contact *contact)
{
    mslip_parameters p = flat_parameters();
    mslip_elliptic_parameters e = elliptic_parameters();
    switch (kind) {
        case 0: break;
        case 1: p.flat_half_width = 0.0; break;
        case 2: p.flat_half_width = 1e-6; break;
        case 3: p.normal_force = 1e-9; break;             /* nearly all flat */
        case 4:                                           /* hardly longer than half the half-width */
            p.normal_force *= 1.7e-4 / p.length;
            p.length = 1.7e-4;
            break;
        case 5: p.normal_force = 0.0; break;              /* open */
        case 6: p.friction_coefficient = 0.0; break;
        default: return mslip_contact_init_elliptic(&e, contact);
    }
    return mslip_contact_init(&p, contact);
}

/* Numbers of a displacement or an amplitude are stretched: from full stick to gross slip, and beyond all measure. */
static const double stretches[] = { 1e-310, 1e-12, 0.03, 1.0, 12.0, 1e140 };
enum { STRETCHES = sizeof stretches / sizeof *stretches };

enum { MOST_VALUES = 1 << 19, MOST_CALLS = 1 << 12 };
static double values[2][MOST_VALUES];
static int32_t statuses[2][MOST_CALLS];

/* The environment is what it was, and of the flags only those were raised that nobody traps. */
static void check_environment(int environment, const char *name, unsigned control)
{
    const int flags = fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    if (!CHECK(flags == 0 && fegetround() == environments[environment].rounding && control_bits() == control)) {
        printf("    %s, %s: flags %x\n", name, environments[environment].name, flags);
    }
}

/* Every function with every contact and every stretch: its status, and its numbers, one array after the other. */
static void run(int environment, int32_t *status, double *value)
{
    const unsigned control = control_bits();
    for (int i = 0; i < FUNCTIONS; ++i) {
        const function *f = &functions[i];
        const size_t items = f->takes & IS_BATCH ? ITEMS : 1;
        for (int kind = 0; kind < CONTACTS; ++kind) {
            for (int stretch = 0; stretch < STRETCHES; ++stretch) {
                set_up(f);
                for (size_t k = 0; k < items; ++k) {
                    CHECK(make_contact((kind + (int)k) % CONTACTS, &contacts()[k]) == MSLIP_OK);
                }
                lead_states(f, HELD);
                for (size_t k = 0; k < f->inputs; ++k) {
                    input()[k] = good_number(f->kind, k, contacts()[0].slip_force);
                    input()[k] *= f->kind == DISPLACEMENT || f->kind == AMPLITUDE ? stretches[stretch] : 1.0;
                }
                call.scalar = good_number(f->scalar, 3, contacts()[0].slip_force);
                call.scalar *= f->scalar == DISPLACEMENT || f->scalar == AMPLITUDE ? stretches[stretch] : 1.0;
                feclearexcept(FE_ALL_EXCEPT);
                *status++ = f->call();
                check_environment(environment, f->name, control);
                for (int k = 0; k < 4; ++k) {
                    memcpy(value, last(out_regions[k], f->out[k] * 8), f->out[k] * 8);
                    value += f->out[k];
                }
            }
        }
    }
}
/* The largest finite number of an array. */
static double largest(const double *value, size_t n)
{
    double most = 0.0;
    for (size_t i = 0; i < n; ++i) {
        if (isfinite(value[i]) && fabs(value[i]) > most) {
            most = fabs(value[i]);
        }
    }
    return most;
}

/* The largest difference of two arrays; infinite where a number is finite in one of them alone. */
static double distance(const double *value, const double *other, size_t n)
{
    double most = 0.0;
    for (size_t i = 0; i < n; ++i) {
        if (!isfinite(value[i]) || !isfinite(other[i])) {
            most = same_bits(&value[i], &other[i], 1) ? most : INFINITY;
        } else if (fabs(value[i] - other[i]) > most) {
            most = fabs(value[i] - other[i]);
        }
    }
    return most;
}

/* How far the numbers of an output may be from the usual ones, over what they come to at most. */
static double tolerance(const function *f, int output, size_t stretch)
{
    if (strcmp(f->name, "mslip_iwan_equivalent") == 0) {
        return output == 2 ? 1e-3 : 1e-6; /* found by bisection to 1e-6, and an error that small is mostly rounding */
    }
    if (strcmp(f->name, "mslip_jenkins_equivalent") == 0) {
        return 1e-5; /* far in gross slip it hangs on the third power of a small angle */
    }
    if (f->rule == MSLIP_BETWEEN_REVERSALS) {
        /* The error of the rule, where rounding divides the period in another way; beyond all measure the root of rounding, with
           which turning points are known. */
        return stretch + 1 < STRETCHES ? 1e-8 : 4e-8;
    }
    return 1e-13; /* some hundred units, all rounded to one side */
}

/* What the numbers of an output come to: the most over all stretches but the last, which goes beyond all measure. Derivatives are
   known to the rounding of a stiffness over the amplitude. */
static double usual_size(const function *f, int output, const double *value, size_t all, size_t n, size_t stretch)
{
    double usual = 0.0;
    for (size_t k = 0; k + 1 < STRETCHES; ++k) {
        const double most = largest(value + k * all, n);
        usual = most > usual ? most : usual;
    }
    if (strstr(f->name, "complex_stiffness") != NULL && output >= 2 && stretch > 0) {
        const double quotient = largest(value + stretch * all - output * n, n) / (4e-8 * stretches[stretch]);
        usual = quotient > usual ? quotient : usual;
    }
    return usual;
}

/* Every number against that of the usual environment; but not what subnormal amplitudes give where these are zeros. */
static void compare(int environment)
{
    const int32_t *status = statuses[0], *other_status = statuses[1];
    const double *value = values[0], *other = values[1];
    for (int i = 0; i < FUNCTIONS; ++i) {
        const function *f = &functions[i];
        const size_t all = f->out[0] + f->out[1] + f->out[2] + f->out[3];
        for (int kind = 0; kind < CONTACTS; ++kind) {
            for (size_t stretch = 0; stretch < STRETCHES; ++stretch) {
                const double *first = value;
                CHECK(*status++ == *other_status++);
                for (int k = 0; k < 4; ++k) {
                    const size_t n = f->out[k];
                    const double usual = usual_size(f, k, first - stretch * all, all, n, stretch), most = largest(value, n);
                    const double scale = most > usual ? most : usual, off = distance(value, other, n);
                    if ((stretch > 0 || environments[environment].flushing == 0) &&
                        !CHECK(off <= tolerance(f, k, stretch) * scale)) {
                        printf("    %s, %s: contact %d, stretch %g, output %d: %.2g of %.2g\n", f->name,
                               environments[environment].name, kind, stretches[stretch], k, off, scale);
                    }
                    value += n;
                    other += n;
                    first += n;
                }
            }
        }
    }
}

/* What is no number is refused in every environment, and so is what is below zero by the least there is. */
static void refuse(int environment)
{
    const unsigned control = control_bits();
    const double least_negative = from_bits(0x8000000000000001);
    for (int i = 0; i < FUNCTIONS; ++i) {
        const function *f = &functions[i];
        set_up(f);
        double *number = f->scalar != NONE ? &call.scalar : input();
        const int kind = f->scalar != NONE ? f->scalar : f->kind;
        for (int k = 0; kind != NONE && k < NOT_NUMBERS; ++k) {
            memcpy(number, &not_numbers[k], sizeof *number);
            feclearexcept(FE_ALL_EXCEPT);
            CHECK(f->call() == status_of_no_number(kind));
            check_environment(environment, f->name, control);
        }
        if (kind == AMPLITUDE || kind == FORCE_AMPLITUDE) {
            memcpy(number, &least_negative, sizeof *number);
            CHECK(f->call() == status_of_no_number(kind));
            check_environment(environment, f->name, control);
        }
    }
    for (int k = 0; k < NOT_NUMBERS; ++k) {
        mslip_parameters p = flat_parameters();
        mslip_contact contact;
        memcpy(&p.edge_radius, &not_numbers[k], sizeof p.edge_radius);
        CHECK(mslip_contact_init(&p, &contact) == MSLIP_BAD_EDGE_RADIUS);
        p = flat_parameters();
        p.length = from_bits(1);
        CHECK(mslip_contact_init(&p, &contact) == MSLIP_OUT_OF_RANGE);
        memcpy(&p.length, &least_negative, sizeof p.length);
        CHECK(mslip_contact_init(&p, &contact) == MSLIP_BAD_LENGTH);
        check_environment(environment, "mslip_contact_init", control);
    }
}

/* Flags that are raised before a call stay raised; those that may be trapped, where they are not. */
static void keep_flags(int traps)
{
    const int raised_before = traps ? FE_INEXACT | FE_UNDERFLOW : FE_ALL_EXCEPT;
    fexcept_t flags;
    feclearexcept(FE_ALL_EXCEPT);
    feraiseexcept(raised_before);
    fegetexceptflag(&flags, FE_ALL_EXCEPT);
    for (int i = 0; i < FUNCTIONS; ++i) {
        set_up(&functions[i]);
        fesetexceptflag(&flags, FE_ALL_EXCEPT);
        CHECK(functions[i].call() == MSLIP_OK && fetestexcept(FE_ALL_EXCEPT) == raised_before);
        call.contacts = NULL;
        CHECK(functions[i].call() == MSLIP_NULL_POINTER && fetestexcept(FE_ALL_EXCEPT) == raised_before);
    }
    feclearexcept(FE_ALL_EXCEPT);
}

int main(int argc, char **argv)
{
    const int traps = check_arguments(argc, argv) > 1;
    make_regions();
    enter(0);
    run(0, statuses[0], values[0]);
    for (int environment = 0; environment < ENVIRONMENTS; ++environment) {
        enter(environment);
        run(environment, statuses[1], values[1]);
        refuse(environment);
        enter(0);
        compare(environment);
    }
    keep_flags(traps);
    return check_report();
}
