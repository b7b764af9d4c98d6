/* What newlib's sources do not give in the form that the C library has: single precision and pairs.
   A float function is the double one, rounded: right to the last bit but for one argument in some hundred million. */
#include <math.h>

#define VINEROW_FLOAT(name) \
  float name##f(float x) { return (float)name((double)x); }
#define VINEROW_FLOAT2(name) \
  float name##f(float x, float y) { return (float)name((double)x, (double)y); }

VINEROW_FLOAT(sin)
VINEROW_FLOAT(cos)
VINEROW_FLOAT(tan)
VINEROW_FLOAT(asin)
VINEROW_FLOAT(acos)
VINEROW_FLOAT(atan)
VINEROW_FLOAT(sinh)
VINEROW_FLOAT(cosh)
VINEROW_FLOAT(tanh)
VINEROW_FLOAT(asinh)
VINEROW_FLOAT(acosh)
VINEROW_FLOAT(atanh)
VINEROW_FLOAT(exp)
VINEROW_FLOAT(exp2)
VINEROW_FLOAT(expm1)
VINEROW_FLOAT(log)
VINEROW_FLOAT(log2)
VINEROW_FLOAT(log10)
VINEROW_FLOAT(log1p)
VINEROW_FLOAT(cbrt)
VINEROW_FLOAT(erf)
VINEROW_FLOAT(erfc)
VINEROW_FLOAT(tgamma)
VINEROW_FLOAT2(atan2)
VINEROW_FLOAT2(pow)
VINEROW_FLOAT2(hypot)

/* GNU's pair: compilers join sin and cos of one argument to it. */
void sincos(double x, double* sine, double* cosine) {
  *sine = sin(x);
  *cosine = cos(x);
}

void sincosf(float x, float* sine, float* cosine) {
  *sine = sinf(x);
  *cosine = cosf(x);
}

double exp10(double x) { return pow(10.0, x); }
float exp10f(float x) { return (float)pow(10.0, (double)x); }
