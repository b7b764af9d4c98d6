#pragma once
/// Standard normal and Student's t distributions, for intervals and tests.
///
/// Computed by Boost.Math in double precision only, with the elementary functions of this project,
/// so that a study's numbers do not depend on the C library. On a processor without SSE2 Boost
/// evaluates one polynomial in another order, which may change the last bits. No heap, no state,
/// thread safe.

namespace vinerow::study {

/// P(Z <= z) of a standard normal Z. @pre z is not NaN; an infinite one gives 0 or 1
double normal_probability(double z);

/// z with P(Z <= z) = probability. @pre 0 < probability < 1
double normal_quantile(double probability);

/// t with P(T <= t) = probability, of Student's distribution.
/// @pre 0 < probability < 1, freedom > 0 (degrees of freedom)
double student_quantile(double probability, double freedom);

/// P(|T| >= |t|) of Student's distribution, accurate even if it is tiny.
/// @pre t is not NaN, an infinite one gives 0; freedom > 0 (degrees of freedom)
double student_two_sided(double t, double freedom);

}  // namespace vinerow::study
