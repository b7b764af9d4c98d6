/// The whole LinearMpc::solve() along closed loops in which limits come and go: state, previewed
/// reference, disturbance and the input before go in, inputs and predicted states come out. The QP
/// alone: qp_bench.cpp. Counters: median and 99th percentile in microseconds of processor time, the
/// mean number of changes of the active set, the share of solves with a limit active, and the
/// largest difference of the inputs to a controller started cold with a tolerance of 1e-12.

#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include "controllers/parts/solvers/discretise.h"
#include "controllers/parts/solvers/linear_mpc.h"
#include "controllers/parts/solvers/riccati.h"
#include "engine/core/random.h"

namespace vinerow::mpc_bench {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Hard state limits could not be met after a push: they give way at a price.
constexpr double kSoftWeight = 1e4;

/// |F x| <= limit at every step, soft.
controllers::MpcStateRows symmetric_rows(const MatrixXd& F, const VectorXd& limit) {
  controllers::MpcStateRows rows;
  rows.F = F;
  rows.upper = limit;
  rows.lower = -limit;
  rows.soft_weight.setConstant(F.rows(), kSoftWeight);
  return rows;
}

/// Quadrotor linearised at hover: p, v, roll-pitch-yaw, rates; inputs are the thrusts of four
/// rotors less their share of the weight. 20 Hz, N = 20, box bounds of inputs and all states. Mass
/// and inertia of a 1 kg airframe, as in qp_bench.cpp.
controllers::LinearMpcProblem quadrotor() {
  const double g = 9.81, mass = 1.0, arm = 0.2, Ix = 0.01, Iz = 0.02, moment = 0.02;
  MatrixXd A = MatrixXd::Zero(12, 12), B = MatrixXd::Zero(12, 4);
  A.block(0, 3, 3, 3).setIdentity();
  A.block(6, 9, 3, 3).setIdentity();
  A(3, 7) = g;
  A(4, 6) = -g;
  A.block(3, 3, 3, 3).diagonal().setConstant(-0.1);
  B.row(5).setConstant(1.0 / mass);
  B.row(9) << 0.0, arm / Ix, 0.0, -arm / Ix;
  B.row(10) << -arm / Ix, 0.0, arm / Ix, 0.0;
  B.row(11) << moment / Iz, -moment / Iz, moment / Iz, -moment / Iz;
  const controllers::SampledModel model = controllers::discretise(A, B, 0.05);
  controllers::LinearMpcProblem problem;
  problem.A = model.A;
  problem.B = model.B;
  VectorXd weights(12), limits(12);
  weights << 10, 10, 10, 1, 1, 1, 1, 1, 1, 0.1, 0.1, 0.1;
  problem.Q = weights.asDiagonal();
  problem.R = 0.1 * MatrixXd::Identity(4, 4);
  problem.input_lower.setConstant(4, -1.0);
  problem.input_upper.setConstant(4, 1.0);
  limits << 10, 10, 10, 1.0, 1.0, 0.6, 0.3, 0.3, 0.5, 1.5, 1.5, 1.0;
  problem.state_rows.push_back(symmetric_rows(MatrixXd::Identity(12, 12), limits));
  problem.horizon = 20;
  return problem;
}

/// Four carts joined by springs (position, speed), three forces between neighbours; 16 limits per
/// step: all states, and the differences of positions and speeds around the ring. N = 15.
controllers::LinearMpcProblem coupled_carts() {
  const double dt = 0.1;
  controllers::LinearMpcProblem problem;
  problem.A.setIdentity(8, 8);
  problem.B.setZero(8, 3);
  for (int i = 0; i < 4; ++i) {
    problem.A(2 * i, 2 * i + 1) = dt;
    problem.A(2 * i + 1, 2 * i + 1) = 1.0 - 0.2 * dt;
    problem.A(2 * i + 1, 2 * i) = -0.5 * dt;
    for (const int j : {i - 1, i + 1}) {
      if (j < 0 || j > 3) continue;
      problem.A(2 * i + 1, 2 * j) += 2.0 * dt;
      problem.A(2 * i + 1, 2 * i) -= 2.0 * dt;
    }
    if (i == 3) continue;
    problem.B(2 * i + 1, i) = dt;
    problem.B(2 * i + 3, i) = -dt;
  }
  problem.Q.setIdentity(8, 8);
  problem.R = 0.05 * MatrixXd::Identity(3, 3);
  problem.input_lower.setConstant(3, -1.0);
  problem.input_upper.setConstant(3, 1.0);
  MatrixXd F = MatrixXd::Zero(16, 8);
  F.topRows(8).setIdentity();
  for (int i = 0; i < 8; ++i) {
    F(8 + i, i) = 1.0;
    F(8 + i, (i + 2) % 8) = -1.0;
  }
  VectorXd limits(16);
  limits << 2, 0.5, 2, 0.5, 2, 0.5, 2, 0.5, 2, 0.8, 2, 0.8, 2, 0.8, 2, 0.8;
  problem.state_rows.push_back(symmetric_rows(F, limits));
  problem.horizon = 15;
  return problem;
}

/// Processor time of this thread: what others do on the machine does not count.
double thread_time_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) * 1e-3;
}

double percentile(std::vector<double> values, double share) {
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

/// What one solve() was given and what it gave.
struct Solved {
  VectorXd x, disturbance, before;
  MatrixXd reference, inputs;
};

/// A closed loop whose reference jumps every 2 s (the jump is previewed as it comes into the
/// horizon), with a push of standard deviation `push` per step, relative to the limits, and a
/// constant disturbance that changes with the reference.
void closed_loop(benchmark::State& state, controllers::LinearMpcProblem problem, double jump,
                 double push) {
  problem.P = controllers::solve_dare(problem.A, problem.B, problem.Q, problem.R).value();
  controllers::LinearMpc warm(problem, "bench");
  const Eigen::Index n = problem.A.rows(), m = problem.B.cols(), N = problem.horizon;
  const VectorXd& limits = problem.state_rows[0].upper;
  RandomStream random(1, "", "mpc_bench");
  VectorXd x = VectorXd::Zero(n), disturbance = x, wanted = x, before = VectorXd::Zero(m);
  MatrixXd reference = MatrixXd::Zero(n, N + 1), input_reference = MatrixXd::Zero(m, N);
  std::vector<double> times_us;
  std::vector<Solved> samples;
  double changes = 0.0;
  std::int64_t step = 0, unsolved = 0;
  for (auto _ : state) {
    if (step % 100 == 0) {
      for (Eigen::Index i = 0; i < 3; ++i) wanted[i] = random.uniform(-jump, jump);
      for (Eigen::Index i = 0; i < n; ++i) disturbance[i] = push * limits[i] * random.normal();
    }
    for (Eigen::Index k = 0; k < N; ++k) reference.col(k) = reference.col(k + 1);
    reference.col(N) = wanted;
    for (Eigen::Index i = 0; i < n; ++i) x[i] += push * limits[i] * random.normal();
    const double begin_us = thread_time_us();
    const controllers::QpStatus status =
        warm.solve(x, reference, input_reference, disturbance, before);
    times_us.push_back(thread_time_us() - begin_us);
    state.SetIterationTime(times_us.back() * 1e-6);
    unsolved += status != controllers::QpStatus::kSolved;
    changes += warm.iterations();
    if (step % 5 == 0) samples.push_back({x, disturbance, before, reference, warm.inputs_ahead()});
    before = warm.u();
    x = problem.A * x + problem.B * before + disturbance;
    ++step;
  }
  // Afterwards, so that it does not take the caches from what is measured.
  controllers::QpSettings precise;
  precise.tolerance = 1e-12;
  controllers::LinearMpc cold(problem, "bench", precise);
  double error = 0.0, limited = 0.0;
  for (const Solved& sample : samples) {
    cold.cold_start();
    cold.solve(sample.x, sample.reference, input_reference, sample.disturbance, sample.before);
    limited += cold.iterations() > 0;
    error = std::max(error, (sample.inputs - cold.inputs_ahead()).cwiseAbs().maxCoeff());
  }
  state.counters["median_us"] = percentile(times_us, 0.5);
  state.counters["p99_us"] = percentile(times_us, 0.99);
  state.counters["worst_us"] = percentile(times_us, 1.0);
  state.counters["changes"] = changes / static_cast<double>(step);
  state.counters["limited"] = limited / static_cast<double>(samples.size());
  state.counters["input_error"] = error;
  state.counters["unsolved"] = static_cast<double>(unsolved);
}

void linear_mpc_quadrotor(benchmark::State& state) {
  closed_loop(state, quadrotor(), 4.0, 0.002);
}
BENCHMARK(linear_mpc_quadrotor)->Iterations(4000)->UseManualTime()->Unit(benchmark::kMicrosecond);

void linear_mpc_carts(benchmark::State& state) {
  closed_loop(state, coupled_carts(), 1.5, 0.002);
}
BENCHMARK(linear_mpc_carts)->Iterations(4000)->UseManualTime()->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace vinerow::mpc_bench
