// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/ipopt_minimizer.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "pipeline/data/internal_error.hpp"

namespace crisp::calibrate {
namespace {

using Ipopt::Index;
using Ipopt::Number;

/// Lets other solves go on while it lives.
class Unlocked {
 public:
  explicit Unlocked(std::unique_lock<std::mutex>& lock) : lock_(lock) { lock_.unlock(); }
  ~Unlocked() { lock_.lock(); }
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  std::unique_lock<std::mutex>& lock_;
};

/// The approximation of a Hessian from the gradients on the way (Broyden, Fletcher, Goldfarb and Shanno),
/// damped as Powell does, so that it stays positive definite where the function is not convex. For a few
/// variables it is better than the limited-memory one that Ipopt has, and a solve costs a fraction.
class SecantHessian {
 public:
  SecantHessian() = default;
  /// @param believed  about the Hessian, up to a factor
  explicit SecantHessian(Eigen::MatrixXd believed) : matrix_(std::move(believed)) {}

  const Eigen::MatrixXd& at(const Eigen::VectorXd& y, const Eigen::VectorXd& gradient) {
    if (y_.size() > 0 && y != y_) update(y - y_, gradient - gradient_);
    y_ = y;
    gradient_ = gradient;
    return matrix_;
  }

 private:
  void update(const Eigen::VectorXd& step, Eigen::VectorXd change) {
    constexpr double kMin = 0.2;  // of the curvature believed so far
    if (is_first_ && step.dot(change) > 0)
      matrix_ *= change.dot(matrix_.llt().solve(change)) / step.dot(change);
    is_first_ = false;
    const Eigen::VectorXd expected = matrix_ * step;
    const double believed = step.dot(expected);
    const double seen = step.dot(change);
    if (seen < kMin * believed) {
      const double share = (1 - kMin) * believed / (believed - seen);
      change = share * change + (1 - share) * expected;
    }
    matrix_ += change * change.transpose() / step.dot(change) - expected * expected.transpose() / believed;
  }

  Eigen::MatrixXd matrix_;
  Eigen::VectorXd y_;
  Eigen::VectorXd gradient_;
  bool is_first_ = true;
};

enum class Borders { kIgnored, kKept };

/// The objective, box and settings of one search.
struct Question {
  const Objective& objective;
  Eigen::VectorXd start;
  const Box& box;
  const MinimizerSettings& settings;
  std::unique_lock<std::mutex>& lock;  ///< of the solvers, held while Ipopt works
};

/// The problem in Ipopt's interface: variables y with x = start + V y. Without borders V is the box's basis.
/// With borders it is diagonal, so that they are bounds of single variables, beyond which Ipopt
/// never evaluates. One object serves many searches of the same size.
class BoxProblem final : public Ipopt::TNLP {
 public:
  BoxProblem(Index size, Borders borders) : size_(size), borders_(borders) {}

  /// @param question  must outlive the search
  void take(const Question& question) {
    question_ = &question;
    const Eigen::MatrixXd& basis = question.box.basis;
    if (borders_ == Borders::kIgnored) {
      variables_ = basis;
      hessian_ =
          SecantHessian(Eigen::MatrixXd::Identity(size_, size_));  // the basis makes curvatures about 1
    } else {
      variables_ = basis.rowwise().norm().asDiagonal();
      const Eigen::MatrixXd to_basis = basis.inverse() * variables_;
      hessian_ = SecantHessian(to_basis.transpose() * to_basis);
    }
    x_.resize(0);
    is_outside_ = false;
    best_ = {.x = question.start, .value = std::numeric_limits<double>::infinity()};
    evaluate(question.start);
    if (!std::isfinite(best_.value))
      throw data::internal_error("the cost function is not a number at the start");
    // As Ipopt's "gradient-based" does, which it would keep from the first question on.
    constexpr double kSteepest = 100;
    factor_ = std::min(1.0, kSteepest / slope().lpNorm<Eigen::Infinity>());
  }

  const Minimum& best() const { return best_; }
  /// Whether the last step led out of the box, where the objective makes no sense. (Never with borders.)
  bool left_the_box() const { return is_outside_; }

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = size_;
    m = 0;
    jacobian = 0;
    hessian = n * (n + 1) / 2;
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* lower, Number* upper, Index, Number*, Number*) override {
    constexpr double kUnbounded = 1e19;  // Ipopt's infinity
    std::fill_n(lower, n, -kUnbounded);
    std::fill_n(upper, n, kUnbounded);
    if (borders_ == Borders::kIgnored) return true;
    const Eigen::VectorXd unit = variables_.diagonal();
    Eigen::Map<Eigen::VectorXd>(lower, n) = (question_->box.lower - question_->start).cwiseQuotient(unit);
    Eigen::Map<Eigen::VectorXd>(upper, n) = (question_->box.upper - question_->start).cwiseQuotient(unit);
    return true;
  }

  bool get_starting_point(Index n, bool, Number* y, bool, Number*, Number*, Index, bool, Number*) override {
    std::fill_n(y, n, 0.0);
    return true;
  }

  bool eval_f(Index n, const Number* y, bool, Number& value) override {
    value = factor_ * evaluate(at(n, y));
    return std::isfinite(value);
  }

  bool eval_grad_f(Index n, const Number* y, bool, Number* gradient) override {
    evaluate(at(n, y));
    Eigen::Map<Eigen::VectorXd>(gradient, n) = factor_ * slope();
    return gradient_.allFinite();
  }

  bool eval_g(Index, const Number*, bool, Index, Number*) override { return true; }

  bool eval_jac_g(Index, const Number*, bool, Index, Index, Index*, Index*, Number*) override { return true; }

  bool eval_h(Index n, const Number* y, bool, Number weight, Index, const Number*, bool, Index, Index* rows,
              Index* columns, Number* values) override {
    if (values) evaluate(at(n, y));
    const Eigen::MatrixXd* hessian =
        values ? &hessian_.at(Eigen::Map<const Eigen::VectorXd>(y, n), slope()) : nullptr;
    for (Index i = 0, k = 0; i < n; ++i) {
      for (Index j = 0; j <= i; ++j, ++k) {
        if (hessian) {
          values[k] = weight * factor_ * (*hessian)(i, j);
        } else {
          rows[k] = i;
          columns[k] = j;
        }
      }
    }
    return true;
  }

  bool intermediate_callback(Ipopt::AlgorithmMode, Index iteration, Number, Number, Number, Number, Number,
                             Number, Number, Number, Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    best_.iterations = iteration;
    if (left_the_box()) return false;
    return !question_->settings.interrupted || !question_->settings.interrupted();
  }

  void finalize_solution(Ipopt::SolverReturn, Index, const Number*, const Number*, const Number*, Index,
                         const Number*, const Number*, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {}

 private:
  /// The gradient by y, at the last evaluated point.
  Eigen::VectorXd slope() const { return variables_.transpose() * gradient_; }

  /// Without borders, trial steps may leave the box, in which alone the objective need make sense.
  Eigen::VectorXd at(Index n, const Number* y) {
    const Eigen::VectorXd x = question_->start + variables_ * Eigen::Map<const Eigen::VectorXd>(y, n);
    Eigen::VectorXd inside = x.cwiseMax(question_->box.lower).cwiseMin(question_->box.upper);
    is_outside_ = borders_ == Borders::kIgnored && x != inside;
    return inside;
  }

  /// Evaluates value and gradient together; Ipopt requests them one after the other at the same x.
  double evaluate(const Eigen::VectorXd& x) {
    if (x_.size() == x.size() && x_ == x) return value_;
    {
      const Unlocked others(question_->lock);
      value_ = question_->objective(x, &gradient_);
    }
    x_ = x;
    if (value_ < best_.value) {
      best_.value = value_;
      best_.x = x;
    }
    return value_;
  }

  Index size_;
  Borders borders_;
  const Question* question_ = nullptr;
  Eigen::MatrixXd variables_;  ///< V: each column is what a unit of one y changes x by
  Eigen::VectorXd x_;
  Eigen::VectorXd gradient_;
  double value_ = 0;
  bool is_outside_ = false;  ///< of the box: the point evaluated last, before it was moved inside
  double factor_ = 1;        ///< of the objective, as Ipopt sees it
  SecantHessian hessian_;
  Minimum best_;
};

std::string in_words(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
      return "converged";
    case Ipopt::Solved_To_Acceptable_Level:
      return "converged to an acceptable level";
    case Ipopt::Search_Direction_Becomes_Too_Small:
      return "the steps became too small to improve further";
    case Ipopt::Maximum_Iterations_Exceeded:
      return "stopped after the most iterations allowed";
    case Ipopt::User_Requested_Stop:
      return "interrupted";
    default:
      return "stopped with Ipopt's status " + std::to_string(static_cast<int>(status));
  }
}

using Application = Ipopt::SmartPtr<Ipopt::IpoptApplication>;

/// With all that is the same for every problem.
Application make_application() {
  Application application = IpoptApplicationFactory();
  auto options = application->Options();
  options->SetIntegerValue("print_level", 0);
  options->SetStringValue("sb", "yes");
  options->SetStringValue("option_file_name", "");      // an ipopt.opt lying about must not change results
  options->SetIntegerValue("min_refinement_steps", 0);  // the systems are small and well conditioned
  // Steps that no longer lower the cost end the search only if there are many: the first ones, before much is
  // known of the curvature, may be small.
  options->SetNumericValue("acceptable_tol", 1e3);
  options->SetIntegerValue("acceptable_iter", 10);
  options->SetStringValue("mu_strategy",
                          "monotone");        // what adaptive ones gain costs more solves than it saves
  options->SetNumericValue("mu_init", 1e-8);  // the start is good: the barrier must not push it away
  options->SetStringValue("nlp_scaling_method", "none");  // BoxProblem scales by itself
  application->Initialize();
  return application;
}

struct Answer {
  Minimum minimum;
  bool left_the_box = false;  ///< and the search stopped there
};

/// An application that keeps, from one question to the next of the same size, what it has set up: that takes
/// longer than many a search.
class Solver {
 public:
  Solver(Index size, Borders borders)
      : borders_(borders), application_(make_application()), problem_(new BoxProblem(size, borders)) {}

  Answer answer(const Question& question) {
    problem_->take(question);
    const MinimizerSettings& settings = question.settings;
    application_->Options()->SetIntegerValue("max_iter", settings.max_iterations);
    // The curvature is below 1: a gradient this small leaves the cost too high by less than the tolerance.
    application_->Options()->SetNumericValue("tol", 0.03 * std::sqrt(settings.tolerance));
    application_->Options()->SetNumericValue("acceptable_obj_change_tol", settings.tolerance);
    application_->Options()->SetStringValue("warm_start_same_structure", is_set_up_ ? "yes" : "no");
    const Ipopt::SmartPtr<Ipopt::TNLP> problem = GetRawPtr(problem_);
    const auto status =
        is_set_up_ ? application_->ReOptimizeTNLP(problem) : application_->OptimizeTNLP(problem);
    // With borders, the order in which the linear system is solved depends on the numbers in it. What was
    // made of one question must not change the next one's answer, not in its last digit.
    is_set_up_ = borders_ == Borders::kIgnored;
    Minimum minimum = problem_->best();
    minimum.status = in_words(status);
    minimum.converged = status == Ipopt::Solve_Succeeded || status == Ipopt::Solved_To_Acceptable_Level ||
                        status == Ipopt::Search_Direction_Becomes_Too_Small;
    return {.minimum = std::move(minimum), .left_the_box = problem_->left_the_box()};
  }

 private:
  Borders borders_;
  Application application_;
  Ipopt::SmartPtr<BoxProblem> problem_;
  bool is_set_up_ = false;
};

/// MUMPS, the linear solver, crashes when two solves run at once. Objectives may: see Unlocked.
struct Solvers {
  std::mutex mutex;
  std::map<std::pair<Eigen::Index, Borders>, std::vector<Solver>> idle;
};

Solvers& solvers() {
  static Solvers all;
  return all;
}

/// One that threw is not used again.
Answer solve(const Question& question, Borders borders) {
  auto& idle = solvers().idle[{question.start.size(), borders}];
  if (idle.empty()) idle.emplace_back(static_cast<Index>(question.start.size()), borders);
  Solver solver = std::move(idle.back());
  idle.pop_back();
  Answer answer = solver.answer(question);
  idle.push_back(std::move(solver));
  return answer;
}

bool is_inside(const Eigen::VectorXd& x, const Box& box) {
  return (x.array() > box.lower.array()).all() && (x.array() < box.upper.array()).all();
}

}  // namespace

Minimum minimize(const Objective& objective, const Eigen::VectorXd& start, const Box& box,
                 const MinimizerSettings& settings) {
  const auto n = start.size();
  if (box.lower.size() != n || box.upper.size() != n || box.basis.rows() != n || box.basis.cols() != n) {
    throw data::internal_error("the start and the box of a minimization have different sizes");
  }
  if (n == 0) return {.x = start, .value = objective(start, nullptr)};
  std::unique_lock lock(solvers().mutex);
  Question question{.objective = objective,
                    .start = start.cwiseMax(box.lower).cwiseMin(box.upper),
                    .box = box,
                    .settings = settings,
                    .lock = lock};
  const auto [found, left_the_box] = solve(question, Borders::kIgnored);
  const bool is_found = !left_the_box && is_inside(found.x, box);
  if (is_found || (settings.interrupted && settings.interrupted())) return found;
  question.start = found.x;
  Minimum kept = solve(question, Borders::kKept).minimum;
  kept.iterations += found.iterations;
  return kept;
}

}  // namespace crisp::calibrate
