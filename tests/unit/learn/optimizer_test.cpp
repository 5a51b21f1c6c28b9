// Optimizers on functions with known optima, compared with published numbers of evaluations
#include "taut/optimizer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

namespace taut {
namespace {

using Function = std::function<double(const std::vector<double>&)>;

/// x = low + u (high - low) for all dimensions
struct Box {
  double low = -20, high = 20;
  std::vector<double> Of(const UnitPoint& u) const {
    std::vector<double> x;
    for (const double v : u) x.push_back(low + v * (high - low));
    return x;
  }
  double Unit(double x) const { return (x - low) / (high - low); }
};

double Sphere(const std::vector<double>& x) {
  double sum = 0;
  for (const double v : x) sum += v * v;
  return sum;
}
double Ellipsoid(const std::vector<double>& x) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double weight = std::pow(1e6, static_cast<double>(i) / static_cast<double>(x.size() - 1));
    sum += weight * x[i] * x[i];
  }
  return sum;
}
double Rosenbrock(const std::vector<double>& x) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    const double a = x[i] * x[i] - x[i + 1], b = x[i] - 1;
    sum += 100 * a * a + b * b;
  }
  return sum;
}
double RosenbrockPairs(const std::vector<double>& x) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < x.size(); i += 2) {
    const double a = x[i] * x[i] - x[i + 1], b = x[i] - 1;
    sum += 100 * a * a + b * b;
  }
  return sum;
}
double Rastrigin(const std::vector<double>& x) {
  double sum = 0;
  for (const double v : x) sum += v * v + 10 - 10 * std::cos(2 * M_PI * v);
  return sum;
}

struct Outcome {
  int evaluations = 0;
  double value = INFINITY;
};

/// Minimizes until `target` or a budget is reached.
Outcome Minimize(const SearchSpec& search, const Function& f, std::size_t n, double start,
                 double target, int budget, std::uint64_t seed, const Box& box = {}) {
  OptimizerStart from;
  from.point.assign(n, box.Unit(start));
  from.seed = seed;
  const auto optimizer = MakeOptimizer(search, from);
  Outcome run;
  while (run.evaluations < budget) {
    std::vector<double> scores;
    for (const UnitPoint& u : optimizer->Ask()) {
      for (const double v : u) {
        EXPECT_GE(v, 0.0);
        EXPECT_LE(v, 1.0);
      }
      const double value = f(box.Of(u));
      scores.push_back(-value);
      ++run.evaluations;
      run.value = std::min(run.value, value);
      if (run.value <= target) return run;
    }
    optimizer->Tell(scores);
  }
  return run;
}

/// Returns the median over eleven seeds.
int MedianEvaluations(const SearchSpec& search, const Function& f, std::size_t n, double start,
                      double target, int budget) {
  std::vector<int> counts;
  for (std::uint64_t seed = 1; seed <= 11; ++seed) {
    counts.push_back(Minimize(search, f, n, start, target, budget, seed).evaluations);
  }
  std::sort(counts.begin(), counts.end());
  return counts[5];
}

SearchSpec CmaEs(double sigma, int lambda) {
  SearchSpec search;
  search.method = CmaEsSpec{sigma / 40};
  search.batch = lambda;
  return search;
}

// Hansen's cma.py 0.9, documentation of fmin: elli, 3*[1], sigma 1, lambda 7: after 1400
// evaluations 5.69e-12. That is a single run, this a median: within a third.
TEST(CmaEs, NeedsThePublishedEvaluationsOnTheEllipsoid) {
  const int median = MedianEvaluations(CmaEs(1, 7), Ellipsoid, 3, 1, 5.69e-12, 5000);
  RecordProperty("evaluations", median);
  EXPECT_GT(median, 1400 * 2 / 3);
  EXPECT_LT(median, 1400 * 4 / 3);
}

// The same documentation: rosen, 4*[-1], sigma 1, lambda 8, to 1e-6: 1472 evaluations of a run that
// found the local optimum. From 1 upward that does not happen; pairs in six dimensions, from 0,
// sigma 1, lambda 9: CMAEvolutionStrategy.jl (README) shows 2394 evaluations to 5.6e-12, with
// negative weights, which save some.
TEST(CmaEs, NeedsThePublishedEvaluationsOnRosenbrocksFunction) {
  const int median = MedianEvaluations(CmaEs(1, 9), RosenbrockPairs, 6, 0, 5.6e-12, 20000);
  RecordProperty("evaluations", median);
  EXPECT_GT(median, 2394 * 2 / 3);
  EXPECT_LT(median, 2394 * 3 / 2);
}

// cma.py asserts, for rosen in ten dimensions from 0.1 with sigma 0.3: below 1e-12 after less than
// 8000 evaluations.
TEST(CmaEs, SolvesRosenbrockInTenDimensionsWithinThePublishedBudget) {
  const int median = MedianEvaluations(CmaEs(0.3, 10), Rosenbrock, 10, 0.1, 1e-12, 30000);
  RecordProperty("evaluations", median);
  EXPECT_LT(median, 8000);
}

// The step length follows the distance: log f decreases linearly, and no slower than for the
// adaptive hill climbing below, a (1+1) strategy with the best step length, times three.
TEST(CmaEs, ConvergesLinearlyOnTheSphere) {
  const int five = MedianEvaluations(CmaEs(1, 10), Sphere, 10, 1, 1e-5, 20000);
  const int ten = MedianEvaluations(CmaEs(1, 10), Sphere, 10, 1, 1e-10, 20000);
  RecordProperty("evaluations", ten);
  EXPECT_NEAR(ten - five, five, 0.3 * five);
  EXPECT_LT(ten, 3 * std::log(10 / 1e-10) / 0.0404);
}

// Invariance under rotation: a rotated ellipsoid gives the same convergence.
TEST(CmaEs, DoesNotDependOnTheAxes) {
  const double s = std::sqrt(0.5);
  const Function turned = [&](const std::vector<double>& x) {
    return Ellipsoid(
        {s * x[0] + s * x[1], s * x[1] - s * x[0], s * x[2] + s * x[3], s * x[3] - s * x[2]});
  };
  const int straight = MedianEvaluations(CmaEs(1, 8), Ellipsoid, 4, 1, 1e-9, 9000);
  const int rotated = MedianEvaluations(CmaEs(1, 8), turned, 4, 1, 1e-9, 9000);
  EXPECT_NEAR(rotated, straight, 0.25 * straight);
}

// N. Hansen, S. Kern, "Evaluating the CMA evolution strategy on multimodal test functions" (PPSN
// 2004): on Rastrigin's function a large population finds the global optimum, the default one does
// not.
TEST(CmaEs, NeedsALargePopulationOnRastriginsFunction) {
  int small = 0, large = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    small += Minimize(CmaEs(2, 8), Rastrigin, 5, 2.5, 1e-8, 6000, seed).value <= 1e-8;
    large += Minimize(CmaEs(2, 400), Rastrigin, 5, 2.5, 1e-8, 100000, seed).value <= 1e-8;
  }
  EXPECT_GE(large, 8);
  EXPECT_LE(small, 4);
}

TEST(CmaEs, FindsAnOptimumOnTheBounds) {
  const Function f = [](const std::vector<double>& x) { return Sphere({x[0] - 20, x[1] - 3}); };
  EXPECT_LT(Minimize(CmaEs(8, 8), f, 2, 0, 1e-8, 5000, 1).value, 1e-6);
}

SearchSpec HillClimbing(double deviation, bool adapt, int batch) {
  SearchSpec search;
  search.method = HillClimbingSpec{deviation, adapt};
  search.batch = batch;
  return search;
}

// A (1+1) strategy with an optimal step length gains at most a factor exp(-0.4 / n) per evaluation
// (Rechenberg; 0.202 / n in the distance, twice that in f); this one must come within three times
// that.
TEST(HillClimbing, AdaptsItsStepOnTheSphere) {
  const int n = 10;
  const int evaluations =
      MedianEvaluations(HillClimbing(1.0 / 40, true, 1), Sphere, n, 1, 1e-10, 50000);
  const double best = std::log(10 / 1e-10) / (0.404 / n);
  RecordProperty("evaluations", evaluations);
  EXPECT_GT(evaluations, 0.8 * best);
  EXPECT_LT(evaluations, 3 * best);
}

// With a fixed step of standard deviation s, as in NTRT, it cannot get closer than about s.
TEST(HillClimbing, WithAFixedStepStallsAtItsLength) {
  const Outcome run = Minimize(HillClimbing(1.0 / 40, false, 1), Sphere, 10, 3, 1e-10, 4000, 1);
  EXPECT_GT(run.value, 1e-3);
  EXPECT_LT(run.value, 10.0);
}

TEST(MonteCarlo, OneAtATimeItGoesOnFromTheStart) {
  SearchSpec spec;
  spec.batch = 1;
  OptimizerStart start;
  start.point = {0.5, 0.25};
  const auto search = MakeOptimizer(spec, start);
  const auto next = [&] {
    const UnitPoint point = search->Ask().at(0);
    search->Tell({0.0});
    return point;
  };
  EXPECT_EQ(next(), start.point);
  const UnitPoint second = next(), third = next();
  EXPECT_NE(second, start.point);
  EXPECT_NE(third, second);
}

TEST(MonteCarlo, CoversTheCubeEvenly) {
  SearchSpec search;
  search.batch = 1000;
  OptimizerStart from{{0.5, 0.5, 0.5}, 0.0, 1, 0};
  const auto points = MakeOptimizer(search, from)->Ask();
  ASSERT_EQ(points.size(), 1000u);
  for (int octant = 0; octant < 8; ++octant) {
    const auto count = std::count_if(points.begin(), points.end(), [&](const UnitPoint& p) {
      return (p[0] > 0.5) == ((octant & 1) != 0) && (p[1] > 0.5) == ((octant & 2) != 0) &&
             (p[2] > 0.5) == ((octant & 4) != 0);
    });
    EXPECT_NEAR(static_cast<double>(count), 125, 5 * std::sqrt(1000 * (7 / 64.0)));
  }
}

SearchSpec Nlopt(const std::string& algorithm, int starts) {
  SearchSpec search;
  search.method = NloptSpec{algorithm, starts, 0.05};
  search.batch = starts;
  return search;
}

TEST(Nlopt, EveryAlgorithmSolvesTheSphere) {
  for (const std::string& algorithm : NloptAlgorithms()) {
    const Outcome run = Minimize(Nlopt(algorithm, 3), Sphere, 3, 7, 1e-4, 3000, 1);
    EXPECT_LE(run.value, 1e-4) << algorithm;
  }
}

// From a single start Nelder-Mead ends in the nearest local optimum; many starts find the global
// one.
TEST(Nlopt, ManyStartsFindWhatOneDoesNot) {
  const Function f = [](const std::vector<double>& x) {  // optima at -10 (value 1) and 10 (value 0)
    return std::min(Sphere({x[0] + 10, x[1]}) + 1, Sphere({x[0] - 10, x[1]}));
  };
  EXPECT_GT(Minimize(Nlopt("nelder_mead", 1), f, 2, -9, 1e-3, 60, 1).value, 0.9);
  EXPECT_LT(Minimize(Nlopt("nelder_mead", 8), f, 2, -9, 1e-3, 2000, 1).value, 1e-3);
}

// --- common properties ----------------------------------------------------------------------

std::map<std::string, SearchSpec> All() {
  SearchSpec monte_carlo;
  monte_carlo.batch = 5;
  return {{"monte_carlo", monte_carlo},    {"hill_climbing", HillClimbing(0.1, true, 5)},
          {"cma_es", CmaEs(4, 6)},         {"nelder_mead", Nlopt("nelder_mead", 3)},
          {"bobyqa", Nlopt("bobyqa", 3)},  {"cobyla", Nlopt("cobyla", 3)},
          {"subplex", Nlopt("subplex", 3)}};
}

/// Fails in half of the space.
double Holes(const UnitPoint& u) { return u[0] < 0.5 ? NAN : -Sphere({u[0] - 0.7, u[1] - 0.2}); }

TEST(Optimizer, AsksTheSameAgainWhenToldTheSame) {
  for (const auto& [name, search] : All()) {
    std::vector<std::vector<UnitPoint>> first;
    for (int repetition = 0; repetition < 2; ++repetition) {
      const auto optimizer = MakeOptimizer(search, {{0.6, 0.5}, std::nullopt, 7, 0});
      for (std::size_t batch = 0; batch < 20; ++batch) {
        const auto points = optimizer->Ask();
        if (repetition == 0) {
          first.push_back(points);
        } else {
          EXPECT_EQ(points, first[batch]) << name;
        }
        std::vector<double> scores;
        for (const UnitPoint& u : points) scores.push_back(Holes(u));
        optimizer->Tell(scores);
      }
    }
    const auto other = MakeOptimizer(search, {{0.6, 0.5}, std::nullopt, 8, 0})->Ask();
    EXPECT_NE(other, first[0]) << name;
  }
}

TEST(Optimizer, FailuresAreNeverBetterThanAnything) {
  for (const auto& [name, search] : All()) {
    const auto optimizer = MakeOptimizer(search, {{0.45, 0.5}, std::nullopt, 3, 0});
    double best = -INFINITY;
    for (int i = 0; i < 1200;) {
      std::vector<double> scores;
      for (const UnitPoint& u : optimizer->Ask()) {
        scores.push_back(Holes(u));
        ++i;
        if (!std::isnan(scores.back())) best = std::max(best, scores.back());
      }
      optimizer->Tell(scores);
    }
    EXPECT_GT(best, -0.01) << name;
  }
}

TEST(Optimizer, StartsWhereItIsTold) {
  for (const auto& [name, search] : All()) {
    if (name == "cma_es") continue;  // its draws are distributed around the start
    EXPECT_EQ(MakeOptimizer(search, {{0.6, 0.5}, std::nullopt, 7, 0})->Ask()[0],
              (UnitPoint{0.6, 0.5}))
        << name;
  }
}

}  // namespace
}  // namespace taut
