// Elementary functions: ours and the C library's, per call.
#include <benchmark/benchmark.h>
#include <dlfcn.h>

#include <array>
#include <cmath>

namespace {

using Function = double (*)(double);
using Function2 = double (*)(double, double);

/// The C library's own: what the program calls by name is ours.
void* of_c_library(const char* name) {
  static void* library = dlopen("libm.so.6", RTLD_NOW | RTLD_LOCAL);
  return library != nullptr ? dlsym(library, name) : nullptr;
}

/// @param theirs  the C library's function instead of ours
void time_function(benchmark::State& state, const char* name, Function ours, bool theirs) {
  const auto function = theirs ? reinterpret_cast<Function>(of_c_library(name)) : ours;
  if (function == nullptr) return state.SkipWithError("the C library has no such function");
  std::array<double, 1024> x{};
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = 0.01 + 2.9 * static_cast<double>(i) / 1024.0;
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(function(x[++i % x.size()]));
}

void time_function2(benchmark::State& state, const char* name, Function2 ours, bool theirs) {
  const auto function = theirs ? reinterpret_cast<Function2>(of_c_library(name)) : ours;
  if (function == nullptr) return state.SkipWithError("the C library has no such function");
  std::array<double, 1024> x{};
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = 0.01 + 2.9 * static_cast<double>(i) / 1024.0;
  std::size_t i = 0;
  for (auto _ : state) {
    ++i;
    benchmark::DoNotOptimize(function(x[i % x.size()], x[(7 * i) % x.size()]));
  }
}

#define VINEROW_TIME(how, name)                                                                    \
  BENCHMARK_CAPTURE(how, Elementary_##name, #name, static_cast<decltype(&::name)>(::name), false); \
  BENCHMARK_CAPTURE(how, Elementary_##name##_of_libm, #name,                                       \
                    static_cast<decltype(&::name)>(::name), true)

VINEROW_TIME(time_function, sin);
VINEROW_TIME(time_function, cos);
VINEROW_TIME(time_function, tan);
VINEROW_TIME(time_function, atan);
VINEROW_TIME(time_function, exp);
VINEROW_TIME(time_function, log);
VINEROW_TIME(time_function, tanh);
VINEROW_TIME(time_function2, atan2);
VINEROW_TIME(time_function2, pow);
VINEROW_TIME(time_function2, hypot);

}  // namespace
