/// Levenberg-Marquardt method against closed forms
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <atomic>
#include <bit>
#include <cmath>

#include "unit/fit/fit_problems.h"

namespace taut {
namespace {

using test::MakeProblem;
using test::Parameter;

/// (A^T A + P)^-1 (A^T b + P m), P = diag(1 / sd^2): the normal equations
Eigen::VectorXd NormalEquations(const test::Linear& linear, const std::vector<FitParameter>& p) {
  const auto rows = static_cast<Eigen::Index>(linear.A.size());
  const auto n = static_cast<Eigen::Index>(p.size());
  Eigen::MatrixXd A(rows, n);
  Eigen::VectorXd b(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) A(i, j) = linear.A[i][j];
    b[i] = linear.b[i];
  }
  Eigen::MatrixXd M = A.transpose() * A;
  Eigen::VectorXd right = A.transpose() * b;
  for (Eigen::Index j = 0; j < n; ++j) {
    const double w = 1.0 / (p[j].prior_sd * p[j].prior_sd);
    M(j, j) += w;
    right[j] += w * p[j].prior_mean.value_or(p[j].start);
  }
  return M.ldlt().solve(right);
}

TEST(FitSearch, ALinearProblemHasTheSolutionOfTheNormalEquations) {
  const test::Linear linear = test::RandomLinear(30, 4, 1);
  std::vector<FitParameter> p = {Parameter("a", 0.3), Parameter("b", -1, 0.1),
                                 Parameter("c", 2, 10), Parameter("d", 0)};
  p[1].prior_sd = 0.2;
  p[3].prior_sd = 0.05;
  p[3].prior_mean = 0.7;
  const FitResult fit = Fit(MakeProblem(p, 30, linear), {});
  EXPECT_EQ(fit.end, FitEnd::kConverged) << fit.why;
  const Eigen::VectorXd expected = NormalEquations(linear, p);
  for (std::size_t j = 0; j < p.size(); ++j) EXPECT_NEAR(fit.values[j], expected[j], 1e-9);
}

TEST(FitSearch, FindsTheEndOfRosenbrocksValley) {
  auto problem = MakeProblem({Parameter("x", -1.2), Parameter("y", 1)}, 2,
                             [](const std::vector<double>& v) -> Residuals {
                               return {{10 * (v[1] - v[0] * v[0]), 1 - v[0]}, ""};
                             });
  const FitResult fit = Fit(problem, {});
  EXPECT_EQ(fit.end, FitEnd::kConverged) << fit.why;
  EXPECT_NEAR(fit.values[0], 1, 1e-9);
  EXPECT_NEAR(fit.values[1], 1, 1e-9);
  EXPECT_LT(fit.state.tracks[0].iterations, 40);
}

/// Data of Kowalik and Osborne with the certified values of NIST's Statistical Reference Datasets,
/// MGH09 (higher difficulty), from both of its starts.
TEST(FitSearch, FindsTheCertifiedMinimumOfKowalikAndOsborne) {
  const std::vector<double> y = {0.1957, 0.1947, 0.1735, 0.1600, 0.0844, 0.0627,
                                 0.0456, 0.0342, 0.0323, 0.0235, 0.0246};
  const std::vector<double> u = {4, 2, 1, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625};
  const auto residuals = [&](const std::vector<double>& x) {
    Residuals r;
    for (std::size_t i = 0; i < y.size(); ++i) {
      r.value.push_back(y[i] -
                        x[0] * (u[i] * u[i] + u[i] * x[1]) / (u[i] * u[i] + u[i] * x[2] + x[3]));
    }
    return r;
  };
  const std::vector<double> certified = {1.9280693458e-1, 1.9128232873e-1, 1.2305650693e-1,
                                         1.3606233068e-1};
  for (const auto& start :
       {std::vector{25.0, 39.0, 41.5, 39.0}, std::vector{0.25, 0.39, 0.415, 0.39}}) {
    std::vector<FitParameter> p;
    for (const double x : start) p.push_back(Parameter(std::to_string(p.size()), x));
    for (FitParameter& one : p) one.step = 1e-4;
    FitOptions options;
    options.most_iterations = 200;
    const FitResult fit = Fit(MakeProblem(p, y.size(), residuals), options);
    EXPECT_NEAR(2 * fit.cost, 3.0750560385e-4, 1e-13) << fit.why;
    for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(fit.values[j] / certified[j], 1, 1e-6);
  }
}

/// The only minimum of the convex problem fulfills the Karush-Kuhn-Tucker conditions.
TEST(FitSearch, ActiveBoundsFulfilTheConditionsOfKarushKuhnAndTucker) {
  int active = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const test::Linear linear = test::RandomLinear(8, 6, seed);
    std::vector<FitParameter> p;
    for (int j = 0; j < 6; ++j) {
      p.push_back(Parameter(std::to_string(j), 0.05));
      p.back().low = -0.1;
      p.back().high = 0.2;
    }
    const FitResult fit = Fit(MakeProblem(p, 8, linear), {});
    const Residuals r = linear(fit.values);
    for (std::size_t j = 0; j < 6; ++j) {
      double gradient = 0;
      for (std::size_t i = 0; i < 8; ++i) gradient += linear.A[i][j] * r.value[i];
      if (fit.values[j] == -0.1) {
        EXPECT_GE(gradient, 0) << seed;
        ++active;
      } else if (fit.values[j] == 0.2) {
        EXPECT_LE(gradient, 0) << seed;
        ++active;
      } else {
        EXPECT_NEAR(gradient, 0, 1e-7) << seed;
      }
    }
  }
  EXPECT_GT(active, 40);
}

TEST(FitSearch, AStartOnABoundIsNoTrap) {
  std::vector<FitParameter> p = {Parameter("x", 0), Parameter("y", 2)};
  p[0].low = 0;
  p[1].high = 2;
  const FitResult fit = Fit(MakeProblem(p, 2,
                                        [](const std::vector<double>& v) -> Residuals {
                                          return {{v[0] - 3 + 0.1 * v[1], v[1] - 1}, ""};
                                        }),
                            {});
  EXPECT_NEAR(fit.values[0], 2.9, 1e-9);
  EXPECT_NEAR(fit.values[1], 1, 1e-9);
}

TEST(FitSearch, AZeroGradientAtTheStartIsNoTrap) {
  // The bow of a strut: only the square of its amplitude has an effect
  std::vector<FitParameter> p = {Parameter("bow", 0), Parameter("offset", 0)};
  const FitResult fit = Fit(MakeProblem(p, 3,
                                        [](const std::vector<double>& v) -> Residuals {
                                          const double s = v[0] * v[0];
                                          return {{s + v[1] - 4, v[1], 2 * s - 8}, ""};
                                        }),
                            {});
  EXPECT_NEAR(std::fabs(fit.values[0]), 2, 1e-7) << fit.why;
  EXPECT_NEAR(fit.values[1], 0, 1e-7);
}

TEST(FitSearch, SeveralStartsFindTheLowerMinimum) {
  // Minima at -1 and, lower, near 1.06: the first start leads to the higher one.
  auto p = Parameter("x", -1.5, 1);
  p.low = -2;
  p.high = 2;
  const auto problem = MakeProblem({p}, 2, [](const std::vector<double>& v) -> Residuals {
    return {{4 * (v[0] * v[0] - 1), 0.5 * (v[0] - 2)}, ""};
  });
  EXPECT_LT(Fit(problem, {}).values[0], 0);
  FitOptions many;
  many.starts = 8;
  const FitResult fit = Fit(problem, many);
  EXPECT_GT(fit.values[0], 0.9);
  EXPECT_EQ(fit.state.tracks.size(), 8u);
}

TEST(FitSearch, RobustLossesForgiveOutliers) {
  math::Random random(3, 7, 0);
  std::vector<double> x, y;
  for (int i = 0; i < 40; ++i) {
    x.push_back(0.1 * i);
    y.push_back(1 + 2 * x.back() + 0.1 * random.Normal());
    if (i % 8 == 3) y.back() += 25;  // five of forty
  }
  const auto fit_with = [&](FitLoss loss) {
    FitProblem problem =
        MakeProblem({Parameter("a", 0), Parameter("b", 0)}, 40, [&](const std::vector<double>& v) {
          Residuals r;
          for (std::size_t i = 0; i < x.size(); ++i) {
            r.value.push_back((v[0] + v[1] * x[i] - y[i]) / 0.1);
          }
          return r;
        });
    for (FitRow& row : problem.rows) row.loss = loss;
    return Fit(problem, {}).values;
  };
  EXPECT_GT(std::fabs(fit_with(FitLoss::kSquare)[0] - 1), 1.0);
  // Two standard errors of the 35 good data: 0.1 * sqrt(4 / 35), plus a third.
  EXPECT_NEAR(fit_with(FitLoss::kCauchy)[0], 1, 0.07);
  EXPECT_NEAR(fit_with(FitLoss::kCauchy)[1], 2, 0.03);
  // Huber bounds an outlier's influence to 1.345 sds: 5 * 1.345 * 0.1 / 40 on the mean.
  EXPECT_NEAR(fit_with(FitLoss::kHuber)[0], 1, 0.12);
  EXPECT_NEAR(fit_with(FitLoss::kHuber)[1], 2, 0.05);
}

TEST(FitSearch, HubersMinimumHasHubersDerivative) {
  // sum psi(r) = 0, psi clipped at the width: for 0, 0, 0, 10 and width 1 the location is 1 / 3.
  FitProblem problem =
      MakeProblem({Parameter("m", 5)}, 4, [](const std::vector<double>& v) -> Residuals {
        return {{v[0], v[0], v[0], v[0] - 10}, ""};
      });
  for (FitRow& row : problem.rows) {
    row.loss = FitLoss::kHuber;
    row.loss_width = 1;
  }
  EXPECT_NEAR(Fit(problem, {}).values[0], 1.0 / 3.0, 1e-6);
}

TEST(FitSearch, FailuresInHalfOfTheSpaceAreToldAndAvoided) {
  // The minimum is in a region in which the model fails: the search ends before it and reports the
  // reason.
  auto p = Parameter("x", 0.2);
  p.low = -3;
  p.high = 3;
  const Forward forward = test::Each([](const std::vector<double>& v) -> Residuals {
    if (v[0] > 1) return {{}, "the robot falls over"};
    return {{v[0] - 2, 0.1 * v[0]}, ""};
  });
  FitProblem problem = MakeProblem({p}, 2, {});
  problem.forward = forward;
  FitOptions options;
  options.starts = 6;
  const FitResult fit = Fit(problem, options);
  EXPECT_NEAR(fit.values[0], 1, 1e-3);
  EXPECT_LE(fit.values[0], 1);
  EXPECT_GT(fit.state.tracks[0].failed, 0);
  EXPECT_EQ(fit.state.tracks[0].reasons.begin()->first, "the robot falls over");
  for (const FitTrack& track : fit.state.tracks) {  // drawn again until the model can be evaluated
    EXPECT_NE(track.end, FitEnd::kFailed);
    EXPECT_LE(track.start[0], 1);
    EXPECT_TRUE(std::isfinite(track.cost));
  }
}

TEST(FitSearch, AnAnswerThatIsNoNumberIsAFailure) {
  const auto nan = MakeProblem({Parameter("x", 0)}, 2, [](const std::vector<double>&) -> Residuals {
    return {{1, std::nan("")}, ""};
  });
  const FitResult fit = Fit(nan, {});
  EXPECT_EQ(fit.end, FitEnd::kFailed);
  EXPECT_EQ(fit.why, "the start could not be computed: residual 1 is not a number");
  const auto few = MakeProblem({Parameter("x", 0)}, 2, [](const std::vector<double>&) -> Residuals {
    return {{1}, ""};
  });
  EXPECT_EQ(Fit(few, {}).why,
            "the start could not be computed: the forward model returned 1 residuals instead of 2");
}

TEST(FitSearch, WhatIsNoProblemIsRefusedWithAllItsMistakes) {
  FitProblem problem;
  problem.parameters = {Parameter("a", 3), Parameter("b", 0), Parameter("b", 0)};
  problem.parameters[0].high = 2;
  problem.parameters[1].prior_sd = 0;
  problem.parameters[2].step = 0;
  const FitResult fit = Fit(problem, {});
  EXPECT_EQ(fit.end, FitEnd::kRefused);
  EXPECT_EQ(fit.why,
            "there is no forward model; there are no data; a: its start is not within its "
            "bounds; b: its prior's standard deviation is not above 0; b: its step is not above "
            "0; b: the name is used twice");
}

/// A problem with several iterations, rejected steps and a failure
FitProblem Winding() {
  std::vector<FitParameter> p = {Parameter("x", -1.2, 0.5), Parameter("y", 1, 0.5)};
  for (FitParameter& one : p) {
    one.low = -3;
    one.high = 3;
  }
  return MakeProblem(p, 3, [](const std::vector<double>& v) -> Residuals {
    if (v[1] > 2.5) return {{}, "too high"};
    return {{10 * (v[1] - v[0] * v[0]), 1 - v[0], std::sin(3 * v[0])}, ""};
  });
}

void ExpectSame(const FitState& a, const FitState& b) {
  ASSERT_EQ(a.tracks.size(), b.tracks.size());
  EXPECT_EQ(a.points, b.points);
  for (std::size_t t = 0; t < a.tracks.size(); ++t) {
    const FitTrack &x = a.tracks[t], &y = b.tracks[t];
    EXPECT_EQ(x.end, y.end);
    EXPECT_EQ(x.iterations, y.iterations);
    EXPECT_EQ(x.failed, y.failed);
    EXPECT_EQ(x.reasons, y.reasons);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(x.cost), std::bit_cast<std::uint64_t>(y.cost));
    for (std::size_t j = 0; j < x.values.size(); ++j) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(x.values[j]),
                std::bit_cast<std::uint64_t>(y.values[j]));
    }
  }
}

TEST(FitSearch, StoppedAfterAnyIterationItGoesOnToTheSameBits) {
  FitOptions options;
  options.starts = 4;
  options.seed = 9;
  const FitResult whole = Fit(Winding(), options);
  EXPECT_GT(whole.state.tracks[0].iterations, 8);
  FitState state;
  int sessions = 0;
  for (bool going = true; going; ++sessions) {
    FitOptions one = options;
    one.progress = [](const FitState&) { return false; };  // one iteration per session
    const FitResult part = Fit(Winding(), one, state);
    state = part.state;
    going = part.end == FitEnd::kInterrupted;
    ASSERT_LT(sessions, 500);
  }
  EXPECT_GT(sessions, 8);
  ExpectSame(state, whole.state);
}

TEST(FitSearch, StoppedWithinAnIterationItGoesOnToTheSameBits) {
  FitOptions options;
  options.starts = 3;
  const FitResult whole = Fit(Winding(), options);
  for (int calls_left = 0; calls_left < 12; ++calls_left) {
    FitProblem problem = Winding();
    int left = calls_left;
    problem.forward = [&left, inner = problem.forward](auto points) {
      return left-- > 0 ? inner(points) : std::vector<Residuals>{};
    };
    const FitResult part = Fit(problem, options);
    ASSERT_EQ(part.end, calls_left == 0 || part.best ? FitEnd::kInterrupted : part.end);
    ExpectSame(Fit(Winding(), options, part.state).state, whole.state);
  }
}

TEST(FitSearch, TheStopFlagStops) {
  std::atomic<bool> stop = false;
  FitOptions options;
  options.stop = &stop;
  options.progress = [&](const FitState& state) {
    if (state.tracks[0].iterations == 2) stop = true;
    return true;
  };
  const FitResult fit = Fit(Winding(), options);
  EXPECT_EQ(fit.end, FitEnd::kInterrupted);
  EXPECT_EQ(fit.state.tracks[0].iterations, 2);
}

TEST(FitSearch, AllPointsOfAnIterationAreAskedForAtOnceAndLieWithinTheBounds) {
  FitProblem problem = Winding();
  std::size_t calls = 0, points_seen = 0;
  problem.forward = [&, inner = problem.forward](std::span<const std::vector<double>> points) {
    ++calls;
    points_seen += points.size();
    for (const auto& point : points) {
      for (const double x : point) EXPECT_TRUE(x >= -3 && x <= 3);
    }
    return inner(points);
  };
  FitOptions options;
  options.starts = 5;
  const FitResult fit = Fit(problem, options);
  int most = 0;
  for (const FitTrack& track : fit.state.tracks) most = std::max(most, track.iterations);
  EXPECT_LE(calls, static_cast<std::size_t>(2 * most + 10));  // 10: starts drawn again
  EXPECT_EQ(points_seen, static_cast<std::size_t>(fit.state.points));
}

TEST(FitSearch, JobsHoldParametersAndLeaveGroupsOut) {
  // Two groups measure x at 1 and at 3; y is measured at 5.
  FitProblem problem = MakeProblem({Parameter("x", 0), Parameter("y", 0)}, 3,
                                   [](const std::vector<double>& v) -> Residuals {
                                     return {{v[0] - 1, v[0] - 3, v[1] - 5}, ""};
                                   });
  problem.rows[1].group = 1;
  const std::vector<FitJob> jobs = {{{0, 0}, {}, {}},
                                    {{0, 0}, {}, {false, true}},
                                    {{0, 0}, {}, {true, false}},
                                    {{7, 0}, {true, false}, {}}};
  const FitState state = RunFitJobs(problem, jobs, {});
  const std::vector<std::vector<double>> expected = {{2, 5}, {1, 5}, {3, 0}, {7, 5}};
  for (std::size_t t = 0; t < 4; ++t) {
    EXPECT_NEAR(state.tracks[t].values[0], expected[t][0], 1e-8) << t;
    EXPECT_NEAR(state.tracks[t].values[1], expected[t][1], 1e-8) << t;
  }
}

}  // namespace
}  // namespace taut
