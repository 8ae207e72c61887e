#pragma once

#include "study/reference.h"

namespace tendril::runner {

/// What a study tries, and what it may spend.
struct Plan {
  std::vector<Method> methods;
  std::vector<double> tolerances;  ///< of the methods that choose their steps, loosest first
  std::vector<double> steps;       ///< of the others, longest first; empty: halves of what is stable
  double budget = 60.0;            ///< CPU seconds in all, up to half of it for the reference
  double cap = 6.0;                ///< CPU seconds of one run
  double target = 1e-3;            ///< position error the reader is after, relative to the scene's length
  std::optional<double> rate;      ///< evaluations that count as a second, in place of CPU time
};

/// How an error falls from one rung of a ladder to the next, in the middle: d log error / d log tolerance, or
/// step.
struct Order {
  Method method;
  double order;
};

struct Advice {
  std::optional<Setting> setting;  ///< nothing when no run meets the target
  std::string sentence;
};

/// Error against run time of one scene.
struct Results {
  Plan plan;
  double length = 0.0;
  std::optional<Reference> reference;
  std::vector<Trial> trials;  ///< by method, then down its ladder
  std::vector<Order> orders;
  Advice advice;
};

/// The part of a study that the reference is taken for.
constexpr double kReferencePart = 0.3;

/// Makes the reference, then goes down all ladders together, loosest rungs first, until the budget is spent.
/// Where a run was capped the tighter ones of its method are skipped. \param told  called before each run
/// with the part that is done
Results carry_out(const Study& study, const Plan& plan, const std::function<void(double part)>& told);

}  // namespace tendril::runner
