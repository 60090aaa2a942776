/* arithmetic.c: a hash of what the compiler's runtime functions compute: complex products and quotients, wide integers, quadruple
   precision, counts of bits. With -DEMBEDDED the application calls the library before and after. */
#ifdef EMBEDDED
#include "all_calls.h"
#endif

#include <complex.h>
#include <float.h>
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { ROUNDS = 20000, LONG_DOUBLE = LDBL_MANT_DIG == 64 ? 10 : sizeof(long double) };

static uint64_t hash = UINT64_C(0xcbf29ce484222325);

/* Adds numbers without their padding. */
static void add(const void *numbers, size_t count, size_t size, size_t stride)
{
    for (size_t i = 0; i < count; ++i) {
        for (size_t j = 0; j < size; ++j) {
            hash = (hash ^ ((const unsigned char *)numbers)[i * stride + j]) * UINT64_C(0x100000001b3);
        }
    }
}

#define ADD(numbers) add(&(numbers), 1, sizeof(numbers), 0)

static uint64_t random_bits(void)
{
    static uint64_t state = UINT64_C(0x9e3779b97f4a7c15);
    state ^= state << 13; /* xorshift */
    state ^= state >> 7;
    state ^= state << 17;
    return state;
}

/* Of any exponent, so that scaling, overflow and underflow occur. */
static double random_double(void)
{
    const uint64_t bits = random_bits();
    double number;
    memcpy(&number, &bits, sizeof number);
    return number == number && bits % 3 != 0 ? number : (double)(int64_t)bits * 1e-19;
}

/* Operands are volatile: everything is computed at run time, by the runtime's functions. */
static void complex_numbers(void)
{
    const volatile double parts[4] = { random_double(), random_double(), random_double(), random_double() };
    double complex x, y;
    memcpy(&x, (double[2]){ parts[0], parts[1] }, sizeof x);
    memcpy(&y, (double[2]){ parts[2], parts[3] }, sizeof y);
    const double complex results[] = { x * y, x / y };
    ADD(results);
    const float complex xf = (float complex)x, yf = (float complex)y, results_f[] = { xf * yf, xf / yf };
    ADD(results_f);
    const long double complex xl = x, yl = y, results_l[] = { xl * yl, xl / yl };
    add(results_l, 4, LONG_DOUBLE, sizeof(long double));
}

static void wide_integers(void)
{
    const volatile uint64_t n = random_bits();
    const int counts[] = { __builtin_popcountll(n), __builtin_parityll(n), __builtin_popcount((unsigned)n) };
    const volatile unsigned __int128 wide = (unsigned __int128)random_bits() << (n & 63) | random_bits();
    const volatile unsigned __int128 divisor = (unsigned __int128)(n | 1) << (random_bits() & 63);
    const volatile __int128 whole = (__int128)wide, part = -(__int128)divisor;
    const unsigned __int128 results[] = { wide / divisor, wide % divisor, wide * divisor, wide << (n & 127) };
    const __int128 with_sign[] = { whole / part, whole % part, whole >> (n & 127), (__int128)(double)(int64_t)n };
    const double rounded = (double)wide;
    ADD(counts);
    ADD(results);
    ADD(with_sign);
    ADD(rounded);
}

static void quadruple_precision(void)
{
    const volatile __float128 x = (__float128)random_double() + (__float128)1e-20, y = (__float128)random_double();
    const __float128 results[] = { x + y, x - y, x * y, x / y, (__float128)(int64_t)random_bits(), (__float128)(float)y };
    const double narrow[] = { (double)results[0], (double)results[2], (double)results[3] };
    const int order[] = { x < y, x == y, x >= y };
    typedef _Complex float quad_complex __attribute__((mode(TC)));
    quad_complex z, w;
    memcpy(&z, &results[0], sizeof z);
    memcpy(&w, &results[2], sizeof w);
    const quad_complex products[] = { z * w, z / w };
    ADD(results);
    ADD(narrow);
    ADD(order);
    ADD(products);
}

int main(void)
{
#ifdef EMBEDDED
    const uint64_t before = hash_of_all();
#endif
    for (int i = 0; i < ROUNDS; ++i) {
        complex_numbers();
        wide_integers();
        quadruple_precision();
    }
    printf("%016" PRIx64 "\n", hash);
#ifdef EMBEDDED
    return hash_of_all() != before;
#endif
}
