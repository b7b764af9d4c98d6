/// The QP solver on problems of model-predictive control: time of warm-started solves along a
/// closed loop, whose state is simulated here. Counters: median and 99th percentile in
/// microseconds of processor time of one solve() (with the new f and limits at hand), the mean
/// number of changes of the active set, and the largest difference of the first input to a solver
/// started cold.

#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <vector>

#include "controllers/parts/solvers/qp.h"
#include "engine/core/random.h"

namespace vinerow::qp_bench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// x_next = A x + B u, with the controller's weights and limits |u| <= u_max, |C x| <= c_max at
/// every stage.
struct Plant {
  Eigen::MatrixXd A, B, C;
  Eigen::VectorXd Q, R, c_max, u_max;
  int horizon = 20;
};

/// The states eliminated: all inputs of the horizon are the variables, the limits of states the
/// rows.
struct Condensed {
  Eigen::MatrixXd H, rows;
  Eigen::MatrixXd f_of_x;     ///< f = f_of_x (x - reference)
  Eigen::MatrixXd rows_of_x;  ///< part of C x that the present x decides
  Eigen::VectorXd u_limit, c_limit;
};

Condensed condense(const Plant& plant) {
  const Eigen::Index states = plant.A.rows(), inputs = plant.B.cols(), N = plant.horizon;
  const Eigen::Index limited = plant.C.rows();
  Eigen::MatrixXd Phi(N * states, states), Gamma(N * states, N * inputs);
  Gamma.setZero();
  Eigen::MatrixXd power = plant.A;
  for (Eigen::Index k = 0; k < N; ++k) {
    Phi.middleRows(k * states, states) = power;
    power = plant.A * power;
    Gamma.block(k * states, k * inputs, states, inputs) = plant.B;
    if (k == 0) continue;
    Gamma.block(k * states, 0, states, k * inputs) =
        plant.A * Gamma.block((k - 1) * states, 0, states, k * inputs);
  }
  const Eigen::VectorXd Q = plant.Q.replicate(N, 1), R = plant.R.replicate(N, 1);
  Condensed qp;
  qp.H = Gamma.transpose() * Q.asDiagonal() * Gamma;
  qp.H.diagonal() += R;
  qp.f_of_x = Gamma.transpose() * Q.asDiagonal() * Phi;
  qp.rows.resize(N * limited, N * inputs);
  qp.rows_of_x.resize(N * limited, states);
  for (Eigen::Index k = 0; k < N; ++k) {
    qp.rows.middleRows(k * limited, limited) = plant.C * Gamma.middleRows(k * states, states);
    qp.rows_of_x.middleRows(k * limited, limited) = plant.C * Phi.middleRows(k * states, states);
  }
  qp.c_limit = plant.c_max.replicate(N, 1);
  qp.u_limit = plant.u_max.replicate(N, 1);
  return qp;
}

/// Quadrotor linearised at hover: p, v, roll-pitch-yaw, rates; inputs are the thrusts of four
/// rotors less their share of the weight. 20 Hz. Mass and inertia of a 1 kg airframe.
Plant quadrotor() {
  const double dt = 0.05, g = 9.81, mass = 1.0, arm = 0.2, Ix = 0.01, Iz = 0.02, moment = 0.02;
  Eigen::MatrixXd Ac = Eigen::MatrixXd::Zero(12, 12), Bc = Eigen::MatrixXd::Zero(12, 4);
  Ac.block(0, 3, 3, 3).setIdentity();
  Ac.block(6, 9, 3, 3).setIdentity();
  Ac(3, 7) = g;
  Ac(4, 6) = -g;
  Ac.block(3, 3, 3, 3).diagonal().setConstant(-0.1);
  Bc.row(5).setConstant(1.0 / mass);
  Bc.row(9) << 0.0, arm / Ix, 0.0, -arm / Ix;
  Bc.row(10) << -arm / Ix, 0.0, arm / Ix, 0.0;
  Bc.row(11) << moment / Iz, -moment / Iz, moment / Iz, -moment / Iz;
  Plant plant;
  plant.A = Eigen::MatrixXd::Identity(12, 12);
  plant.B = Bc * dt;
  Eigen::MatrixXd term = Eigen::MatrixXd::Identity(12, 12);
  for (int i = 1; i < 6; ++i) {  // series of exp(Ac dt)
    term = term * Ac * dt / i;
    plant.A += term;
    plant.B += term * Bc * dt / (i + 1);
  }
  plant.Q.resize(12);
  plant.Q << 10, 10, 10, 1, 1, 1, 1, 1, 1, 0.1, 0.1, 0.1;
  plant.R = Eigen::VectorXd::Constant(4, 0.1);
  plant.u_max = Eigen::VectorXd::Constant(4, 1.0);
  plant.C = Eigen::MatrixXd::Identity(12, 12);
  plant.c_max.resize(12);
  plant.c_max << 10, 10, 10, 1.0, 1.0, 0.6, 0.3, 0.3, 0.5, 1.5, 1.5, 1.0;
  plant.horizon = 20;
  return plant;
}

/// Four carts joined by springs (position, speed), three forces between neighbours; 16 limits per
/// stage: all states, and the differences of positions and speeds around the ring.
Plant coupled_carts() {
  const double dt = 0.1;
  Plant plant;
  plant.A = Eigen::MatrixXd::Identity(8, 8);
  plant.B = Eigen::MatrixXd::Zero(8, 3);
  for (int i = 0; i < 4; ++i) {
    plant.A(2 * i, 2 * i + 1) = dt;
    plant.A(2 * i + 1, 2 * i + 1) = 1.0 - 0.2 * dt;
    for (const int j : {i - 1, i + 1}) {
      if (j < 0 || j > 3) continue;
      plant.A(2 * i + 1, 2 * j) += 2.0 * dt;
      plant.A(2 * i + 1, 2 * i) -= 2.0 * dt;
    }
    if (i < 3) {
      plant.B(2 * i + 1, i) = dt;
      plant.B(2 * i + 3, i) = -dt;
    }
  }
  for (int i = 0; i < 4; ++i) plant.A(2 * i + 1, 2 * i) -= 0.5 * dt;
  plant.Q = Eigen::VectorXd::Ones(8);
  plant.R = Eigen::VectorXd::Constant(3, 0.05);
  plant.u_max = Eigen::VectorXd::Constant(3, 1.0);
  plant.C = Eigen::MatrixXd::Zero(16, 8);
  plant.C.topRows(8).setIdentity();
  for (int i = 0; i < 8; ++i) {
    plant.C(8 + i, i) = 1.0;
    plant.C(8 + i, (i + 2) % 8) = -1.0;
  }
  plant.c_max.resize(16);
  plant.c_max << 2, 0.5, 2, 0.5, 2, 0.5, 2, 0.5, 2, 0.8, 2, 0.8, 2, 0.8, 2, 0.8;
  plant.horizon = 15;
  return plant;
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

/// A closed loop whose reference jumps every 2 s and whose state is pushed about: `noise` is the
/// standard deviation of the push per step, relative to the limits.
void closed_loop(benchmark::State& state, const Plant& plant, double jump, double noise) {
  const Condensed qp = condense(plant);
  const auto n = static_cast<int>(qp.H.rows()), m = static_cast<int>(qp.rows.rows());
  controllers::QpSolver warm(n, m), cold(n, m);
  for (controllers::QpSolver* solver : {&warm, &cold}) {
    solver->set_hessian(qp.H);
    solver->set_rows(qp.rows);
    // Hard state limits could not be met after a push: they give way at a price.
    for (int r = 0; r < m; ++r) solver->soften_row(r, 1e4);
  }
  RandomStream random(1, "", "qp_bench");
  Eigen::VectorXd x = Eigen::VectorXd::Zero(plant.A.rows()), reference = x;
  Eigen::VectorXd f(n), low(m), up(m);
  const Eigen::VectorXd u_low = -qp.u_limit;
  std::vector<double> times_us, unchanged_us, cold_us;
  double error = 0.0, iterations = 0.0, active = 0.0;
  int max_iterations = 0;
  std::int64_t step = 0, unsolved = 0;
  for (auto _ : state) {
    if (step % 100 == 0) {
      reference.setZero();
      for (int i = 0; i < 3; ++i) reference[i] = random.uniform(-jump, jump);
    }
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] += noise * plant.c_max[i] * random.normal();
    f.noalias() = qp.f_of_x * (x - reference);
    up.noalias() = qp.c_limit - qp.rows_of_x * x;
    low.noalias() = -qp.c_limit - qp.rows_of_x * x;
    const double begin_us = thread_time_us();
    const controllers::QpStatus status = warm.solve(f, u_low, qp.u_limit, low, up);
    times_us.push_back(thread_time_us() - begin_us);
    state.SetIterationTime(times_us.back() * 1e-6);
    if (warm.iterations() == 0) unchanged_us.push_back(times_us.back());
    unsolved += status != controllers::QpStatus::kSolved;
    iterations += warm.iterations();
    max_iterations = std::max(max_iterations, warm.iterations());
    active += static_cast<double>(warm.active_set().size());
    if (step % 10 == 0) {
      cold.cold_start();
      const double cold_begin_us = thread_time_us();
      cold.solve(f, u_low, qp.u_limit, low, up);
      cold_us.push_back(thread_time_us() - cold_begin_us);
      const Eigen::Index inputs = plant.B.cols();
      error = std::max(error, (warm.x() - cold.x()).head(inputs).cwiseAbs().maxCoeff());
    }
    x = plant.A * x + plant.B * warm.x().head(plant.B.cols());
    ++step;
  }
  const double solves = static_cast<double>(step);
  state.counters["median_us"] = percentile(times_us, 0.5);
  state.counters["p99_us"] = percentile(times_us, 0.99);
  state.counters["worst_us"] = percentile(times_us, 1.0);
  state.counters["unchanged_us"] = unchanged_us.empty() ? 0.0 : percentile(unchanged_us, 0.5);
  state.counters["cold_us"] = percentile(cold_us, 0.5);
  state.counters["changes"] = iterations / solves;
  state.counters["most_changes"] = max_iterations;
  state.counters["active"] = active / solves;
  state.counters["input_error"] = error;
  state.counters["unsolved"] = static_cast<double>(unsolved);
}

void quadrotor_mpc(benchmark::State& state) {
  closed_loop(state, quadrotor(), 4.0, 0.002);
}
BENCHMARK(quadrotor_mpc)->Iterations(4000)->UseManualTime()->Unit(benchmark::kMicrosecond);

void coupled_carts_mpc(benchmark::State& state) {
  closed_loop(state, coupled_carts(), 1.5, 0.002);
}
BENCHMARK(coupled_carts_mpc)->Iterations(4000)->UseManualTime()->Unit(benchmark::kMicrosecond);

/// Four wheel speeds close to wanted ones with a new Hessian and new rows every time, as a
/// steering law gives them: set_hessian, set_rows and solve.
void wheel_speed_qp(benchmark::State& state) {
  constexpr int kCases = 256;
  RandomStream random(2, "", "qp_bench");
  std::vector<Eigen::Matrix4d> H(kCases);
  std::vector<Eigen::MatrixXd> rows(kCases, Eigen::MatrixXd(6, 4));
  std::vector<Eigen::Vector4d> f(kCases);
  for (int i = 0; i < kCases; ++i) {
    const auto at = static_cast<std::size_t>(i);
    for (int j = 0; j < 4; ++j) f[at][j] = -random.uniform(2.0, 10.0);
    H[at] = Eigen::Matrix4d::Identity();
    for (int r = 0; r < 6; ++r) {
      for (int j = 0; j < 4; ++j) rows[at](r, j) = random.normal();
    }
    H[at] += 0.1 * rows[at].transpose() * rows[at];
  }
  const Eigen::Vector4d low = Eigen::Vector4d::Constant(-8.0), up = -low;
  Eigen::VectorXd row_low = Eigen::VectorXd::Constant(6, -1.5), row_up = -row_low;
  controllers::QpSolver solver(4, 6);
  std::size_t at = 0;
  double iterations = 0.0;
  for (auto _ : state) {
    solver.set_hessian(H[at]);
    solver.set_rows(rows[at]);
    if (solver.solve(f[at], low, up, row_low, row_up) != controllers::QpStatus::kSolved) {
      state.SkipWithError("not solved");
    }
    iterations += solver.iterations();
    at = (at + 1) % kCases;
  }
  state.counters["changes"] = iterations / static_cast<double>(state.iterations());
}
BENCHMARK(wheel_speed_qp)->Unit(benchmark::kNanosecond);

}  // namespace
}  // namespace vinerow::qp_bench
