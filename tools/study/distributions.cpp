#include "tools/study/distributions.h"

// Without this, Boost computes in long double, whose width and functions depend on the machine.
#define BOOST_MATH_PROMOTE_DOUBLE_POLICY false
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "engine/core/check.h"

namespace vinerow::study {
namespace {

using Normal = boost::math::normal_distribution<double>;
using Student = boost::math::students_t_distribution<double>;

}  // namespace

double normal_probability(double z) {
  VINEROW_DEMAND(!std::isnan(z));
  return boost::math::cdf(Normal(), z);
}

double normal_quantile(double probability) {
  VINEROW_DEMAND(probability > 0.0 && probability < 1.0);
  return boost::math::quantile(Normal(), probability);
}

double student_quantile(double probability, double freedom) {
  VINEROW_DEMAND(probability > 0.0 && probability < 1.0 && freedom > 0.0);
  return boost::math::quantile(Student(freedom), probability);
}

double student_two_sided(double t, double freedom) {
  VINEROW_DEMAND(!std::isnan(t) && freedom > 0.0);
  return 2.0 * boost::math::cdf(boost::math::complement(Student(freedom), std::abs(t)));
}

}  // namespace vinerow::study
