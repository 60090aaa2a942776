/* Floating-point environments of the caller: four rounding modes, subnormal values flushed, flags already raised. No call hangs,
   raises an exception that may be trapped, returns another status or changes the environment, and every result is near that of the
   default environment. Rejected values are tested in Rust. */
#include "calls.h"

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
enum { ENVIRONMENTS = LENGTH(environments) };

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

/* Contacts and elements of every kind, each initialised in the environment. */
enum { CONTACT_KINDS = 8 };
static mslip_parameters parameters_of(int kind)
{
    mslip_parameters p = flat_parameters();
    switch (kind) {
        case 5: p.flat_half_width = 1e-6; break;
        case 6: p.normal_force = 1e-9; break; /* nearly flat */
        default:                              /* little longer than half the half-width */
            p.normal_force *= 1.7e-4 / p.length;
            p.length = 1.7e-4;
    }
    return p;
}

static mslip_contact contact_in_environment(int kind)
{
    const mslip_parameters p = parameters_of(kind);
    mslip_contact contact;
    if (kind < KINDS) {
        return init_contact(kind);
    }
    CHECK(mslip_contact_init(&p, &contact) == MSLIP_OK);
    return contact;
}

static mslip_element elements_in_environment[CONTACT_KINDS][VARIANTS];

static void init_elements(void)
{
    for (int kind = 0; kind < CONTACT_KINDS; ++kind) {
        for (int variant = 0; variant < VARIANTS; ++variant) {
            mslip_parameters p = parameters_of(kind);
            if (kind == CONTACT_KINDS - 1 && directions_of(variant) == 2) {
                /* Along the line the stiffness is positive for longer contacts only. */
                p.length *= 3.0;
                p.normal_force *= 3.0;
            }
            mslip_element *element = &elements_in_environment[kind][variant];
            if (kind < KINDS) {
                init_element(kind, variant, element);
            } else {
                CHECK(mslip_element_init(&p, directions_of(variant), normal_input_of(variant), element) == MSLIP_OK);
            }
        }
    }
}

/* Factors of displacements and amplitudes: from full stick to gross slip, and far beyond. */
static const double factors[] = { 1e-310, 1e-12, 0.03, 1.0, 12.0, 1e140 };
enum { FACTORS = LENGTH(factors) };

enum { MOST_VALUES = 1 << 20, MOST_CALLS = 1 << 12 };
static double values[2][MOST_VALUES];
static int32_t statuses[2][MOST_CALLS];

/* The environment is unchanged, and no exception was raised that may be trapped. */
static void check_environment(int environment, const char *name, unsigned control)
{
    const int flags = fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    if (!CHECK(flags == 0 && fegetround() == environments[environment].rounding && control_bits() == control)) {
        printf("    %s, %s: flags %x\n", name, environments[environment].name, flags);
    }
}

/* The factor of a quantity; normal motions of an element are limited by its length. */
static double factor_of(int kind, int factor)
{
    const int is_normal = kind >= APPROACH, is_displacement = kind == DISPLACEMENT || kind == AMPLITUDE;
    return is_normal ? fmin(factors[factor], 3.0) : is_displacement ? factors[factor] : 1.0;
}

/* Every function with every contact or element and every factor: its status, and its results, one array after the other. */
static void run(int environment, int32_t *status, double *value)
{
    const unsigned control = control_bits();
    init_elements();
    check_environment(environment, "mslip_element_init", control);
    for (int i = 0; i < FUNCTIONS; ++i) {
        const function *f = &functions[i];
        const size_t items = items_of(f);
        for (int kind = 0; kind < CONTACT_KINDS; ++kind) {
            for (int factor = 0; factor < FACTORS; ++factor) {
                set_up(f);
                for (size_t k = 0; k < items; ++k) {
                    const int its_kind = (kind + (int)k) % CONTACT_KINDS;
                    if (f->takes & IS_ELEMENT) {
                        ELEMENTS[k] = elements_in_environment[its_kind][f->rule];
                    } else {
                        CONTACTS[k] = contact_in_environment(its_kind);
                    }
                }
                fill_states(f);
                fill_table(f);
                const double slip_force = f->takes & IS_ELEMENT ? 0.0 : CONTACTS[0].slip_force;
                for (size_t k = 0; k < f->inputs; ++k) {
                    const int quantity = kind_of_input(f, k);
                    INPUT[k] = valid_value(quantity, k, slip_force) * factor_of(quantity, factor);
                }
                call.scalar = valid_value(f->scalar, 3, slip_force) * factor_of(f->scalar, factor);
                feclearexcept(FE_ALL_EXCEPT);
                *status++ = f->call();
                check_environment(environment, f->name, control);
                for (int k = 1; k < OUTPUTS; ++k) {
                    memcpy(value, out_memory[k], f->out[k] * sizeof *value);
                    value += f->out[k];
                }
            }
        }
    }
}

/* The largest finite magnitude of an array. */
static double largest(const double *value, size_t n)
{
    double most = 0.0;
    for (size_t i = 0; i < n; ++i) {
        most = isfinite(value[i]) ? fmax(most, fabs(value[i])) : most;
    }
    return most;
}

/* The largest difference of two arrays; infinite if a value is finite in one of them only. */
static double distance(const double *value, const double *other, size_t n)
{
    double most = 0.0;
    for (size_t i = 0; i < n; ++i) {
        if (!isfinite(value[i]) || !isfinite(other[i])) {
            most = same_bits(&value[i], &other[i], 1) ? most : INFINITY;
        } else {
            most = fmax(most, fabs(value[i] - other[i]));
        }
    }
    return most;
}

/* Allowed difference from the default environment, relative to the size of an output. */
static double tolerance(const function *f, int output, size_t factor)
{
    if (strcmp(f->name, "mslip_iwan_equivalent") == 0) {
        return output == 3 ? 1e-3 : 1e-6; /* by bisection to 1e-6; so small an error is mostly rounding */
    }
    if (strcmp(f->name, "mslip_jenkins_equivalent") == 0) {
        return 1e-5; /* far in gross slip it depends on the third power of a small angle */
    }
    if (f->rule == MSLIP_EVENT_DRIVEN) {
        /* The error of the rule if rounding divides the period differently; far in gross slip, the root of rounding, the error of
           the instants of reversals. */
        return factor + 1 < FACTORS ? 1e-8 : 4e-8;
    }
    if ((f->takes & IS_ELEMENT) && (f->takes & (TAKES_STATE | TAKES_WORKSPACE)) && output == 3) {
        /* Energies are accurate to the rounding of mu N times the displacement (docs/accuracy.md); those of a little slip, down to 1e-7 of
           that, lose up to seven digits. */
        return 1e-10;
    }
    if ((f->takes & IS_ELEMENT) && (f->takes & (TAKES_STATE | TAKES_WORKSPACE)) && directions_for(f) == 2) {
        /* The direction of slip is iterated to 1e-11; the memory of two periods of small motions amplifies that by up to 100. */
        return 1e-8;
    }
    return 1e-13; /* hundreds of roundings of one sign */
}

/* The size of an output: the largest magnitude over all factors but the last. Derivatives have the rounding of a stiffness over the
   amplitude. */
static double usual_size(const function *f, int output, const double *value, size_t all, size_t n, size_t factor)
{
    double usual = 0.0;
    for (size_t k = 0; k + 1 < FACTORS; ++k) {
        usual = fmax(usual, largest(value + k * all, n));
    }
    if (strstr(f->name, "complex_stiffness") != NULL && output >= 3 && factor > 0) {
        usual = fmax(usual, largest(value + factor * all - (output - 1) * n, n) / (4e-8 * factors[factor]));
    }
    return usual;
}

/* Of two directions only forces: at the onset of slip rounding decides on which side a one-sided tangent is, and whether energy is
   dissipated. */
static int is_compared(const function *f, int output)
{
    return !(f->takes & IS_ELEMENT) || directions_for(f) == 1 || !(f->takes & (TAKES_STATE | TAKES_WORKSPACE)) || output == 1;
}

/* Every result is compared with that of the default environment, except for subnormal amplitudes if these are flushed. */
static void compare(int environment)
{
    const int32_t *status = statuses[0], *other_status = statuses[1];
    const double *value = values[0], *other = values[1];
    for (int i = 0; i < FUNCTIONS; ++i) {
        const function *f = &functions[i];
        const size_t all = f->out[1] + f->out[2] + f->out[3] + f->out[4];
        for (int kind = 0; kind < CONTACT_KINDS; ++kind) {
            for (size_t factor = 0; factor < FACTORS; ++factor) {
                const double *first = value;
                CHECK(*status++ == *other_status++);
                for (int k = 1; k < OUTPUTS; ++k) {
                    const size_t n = f->out[k];
                    const double usual = usual_size(f, k, first - factor * all, all, n, factor);
                    const double scale = fmax(largest(value, n), usual), off = distance(value, other, n);
                    if ((factor > 0 || environments[environment].flushing == 0) && is_compared(f, k) &&
                        !CHECK(off <= tolerance(f, k, factor) * scale)) {
                        printf("    %s, %s: contact %d, factor %g, output %d: %.2g of %.2g\n", f->name,
                               environments[environment].name, kind, factors[factor], k, off, scale);
                    }
                    value += n;
                    other += n;
                    first += n;
                }
            }
        }
    }
}

/* Flags raised before a call stay raised; with traps, only those that are not trapped. */
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
        call.elements = NULL;
        CHECK(functions[i].call() == MSLIP_NULL_POINTER && fetestexcept(FE_ALL_EXCEPT) == raised_before);
    }
    feclearexcept(FE_ALL_EXCEPT);
}

/* Own states are valid, also with a layer of the smallest N_c: the loads of neighbouring knots differ by the error of the polynomials
   of N(S), which is largest where two of them meet, at shifts S = 2^k (1 + q/4). The displacement of gross slip is mu S. */
static void check_own_states(void)
{
    static double state[2000];
    const size_t length = mslip_element_state_length(1, 200);
    for (int share = 1; share <= 8; ++share) {
        mslip_parameters p = flat_parameters();
        mslip_element element;
        double load = p.normal_force, force = p.friction_coefficient * load, slip, largest;
        int exponent, invalid = 0;
        CHECK(length <= LENGTH(state) && mslip_element_init(&p, 1, MSLIP_INPUT_NORMAL_FORCE, &element) == MSLIP_OK);
        p.layer.normal_compliance = p.layer.tangential_compliance = share / element.tangential_stiffness;
        p.layer.stiffening_load = 1e-3 * load;
        CHECK(mslip_element_init(&p, 1, MSLIP_INPUT_NORMAL_FORCE, &element) == MSLIP_OK);
        CHECK(mslip_element_displacement(&element, 0, 1, &force, &load, &largest, NULL) == MSLIP_OK);
        (void)frexp(largest / p.friction_coefficient, &exponent);
        /* In the largest octave, where N/N_c is largest. An edge beyond the load is at its end. */
        for (int q = 0; q < 4; ++q) {
            const double edge = p.friction_coefficient * ldexp(1.0 + 0.25 * q, exponent - 1);
            double low = 0.0, high = p.normal_force;
            for (int i = 0; i < 60; ++i) {
                load = 0.5 * (low + high);
                force = p.friction_coefficient * load;
                CHECK(mslip_element_displacement(&element, 0, 1, &force, &load, &slip, NULL) == MSLIP_OK);
                *(slip < edge ? &low : &high) = load;
            }
            double input[2] = { 0.0, 0.0 };
            for (int step = 0; step < 800; ++step) {
                input[0] += edge * pow(10.0, -8.0 - 0.1 * (rand() % 60)) * (rand() % 2 ? 1.0 : -1.0);
                input[1] *= 1.0 + 1e-11 * (rand() % 10);
                if (step % 20 == 0) {
                    input[0] = 0.0;
                    input[1] = high * (1.0 + 1e-9 * step / 20);
                    mslip_element_state_init(1, length, state);
                }
                mslip_element_update(&element, length, state, input, state, NULL, NULL, NULL);
                invalid += mslip_element_state_check(1, length, state) != MSLIP_OK;
            }
        }
        if (!CHECK(invalid == 0)) printf("    layer of share %d: %d\n", share, invalid);
    }
}

int main(int argc, char **argv)
{
    const int traps = check_arguments(argc, argv) > 1;
    make_functions();
    enter(0);
    run(0, statuses[0], values[0]);
    for (int environment = 0; environment < ENVIRONMENTS; ++environment) {
        enter(environment);
        run(environment, statuses[1], values[1]);
        check_own_states();
        enter(0);
        compare(environment);
    }
    keep_flags(traps);
    return check_report();
}
