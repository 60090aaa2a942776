/* arithmetic.c: a hash of what the compiler's runtime computes for a host: complex products and quotients, wide integers,
   quadruple precision, counts of bits. With -DGUEST the host calls the library as well. */
#ifdef GUEST
#include "use.h"
#endif

#include <complex.h>
#include <float.h>
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { ROUNDS = 20000 };

static uint64_t sum = UINT64_C(0xcbf29ce484222325);

/* Takes the bits of a number; what pads it is no part of it. */
static void take(const void *number, size_t bytes)
{
    for (size_t i = 0; i < bytes; ++i) {
        sum = (sum ^ ((const unsigned char *)number)[i]) * UINT64_C(0x100000001b3);
    }
}

enum { LONG_DOUBLE = LDBL_MANT_DIG == 64 ? 10 : sizeof(long double) };

#define TAKE(number) take(&(number), sizeof(number))
#define TAKE_COMPLEX(type, size, z) \
    do { \
        type parts[2]; \
        memcpy(parts, &(z), sizeof parts); \
        take(&parts[0], size); \
        take(&parts[1], size); \
    } while (0)

static uint64_t next(void)
{
    static uint64_t state = UINT64_C(0x9e3779b97f4a7c15);
    state ^= state << 13; /* xorshift */
    state ^= state >> 7;
    state ^= state << 17;
    return state;
}

/* Of any exponent, so that scaling, overflow and underflow are met. */
static double any(void)
{
    const uint64_t bits = next();
    double number;
    memcpy(&number, &bits, sizeof number);
    return number == number && bits % 3 != 0 ? number : (double)(int64_t)bits * 1e-19;
}

/* Operands are volatile: everything is computed at run time, by the runtime's functions. */
static void complex_numbers(void)
{
    volatile double parts[4];
    for (int i = 0; i < 4; ++i) {
        parts[i] = any();
    }
    /* Not by x + I y, which multiplies an infinite y by a zero. */
    double complex x, y;
    memcpy(&x, (double[2]){ parts[0], parts[1] }, sizeof x);
    memcpy(&y, (double[2]){ parts[2], parts[3] }, sizeof y);
    const double complex product = x * y, quotient = x / y;
    TAKE_COMPLEX(double, sizeof(double), product);
    TAKE_COMPLEX(double, sizeof(double), quotient);

    const float complex xf = (float complex)x, yf = (float complex)y;
    const float complex product_f = xf * yf, quotient_f = xf / yf;
    TAKE_COMPLEX(float, sizeof(float), product_f);
    TAKE_COMPLEX(float, sizeof(float), quotient_f);

    const long double complex xl = x, yl = y;
    const long double complex product_l = xl * yl, quotient_l = xl / yl;
    TAKE_COMPLEX(long double, LONG_DOUBLE, product_l);
    TAKE_COMPLEX(long double, LONG_DOUBLE, quotient_l);
}

static void bits_of_integers(void)
{
    const volatile uint64_t n = next();
    const int counts[] = { __builtin_popcountll(n), __builtin_parityll(n), __builtin_popcount((unsigned)n) };
    TAKE(counts);
#ifdef __SIZEOF_INT128__
    const volatile unsigned __int128 wide = (unsigned __int128)next() << (n & 63) | next();
    const volatile unsigned __int128 divisor = (unsigned __int128)(n | 1) << (next() & 63);
    const volatile __int128 whole = (__int128)wide, part = -(__int128)divisor;
    const unsigned __int128 results[] = { wide / divisor, wide % divisor, wide * divisor, wide << (n & 127) };
    const __int128 with_sign[] = { whole / part, whole % part, whole >> (n & 127), (__int128)(double)(int64_t)n };
    const double rounded = (double)wide;
    TAKE(results);
    TAKE(with_sign);
    TAKE(rounded);
#endif
}

static void quadruple_precision(void)
{
#ifdef __SIZEOF_FLOAT128__
    const volatile __float128 x = (__float128)any() + (__float128)1e-20, y = (__float128)any();
    const __float128 results[] = { x + y, x - y, x * y, x / y, (__float128)(int64_t)next(), (__float128)(float)any() };
    const double narrow[] = { (double)results[0], (double)results[2], (double)results[3] };
    const int order[] = { x < y, x == y, x >= y };
    TAKE(results);
    TAKE(narrow);
    TAKE(order);
#endif
}

int main(void)
{
#ifdef GUEST
    const uint64_t before = visit_all();
#endif
    for (int i = 0; i < ROUNDS; ++i) {
        complex_numbers();
        bits_of_integers();
        quadruple_precision();
    }
    printf("%016" PRIx64 "\n", sum);
#ifdef GUEST
    return visit_all() != before;
#endif
}
