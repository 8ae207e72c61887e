#include "bench/contest.h"

#ifdef TENDRIL_BENCH_SUNDIALS

#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>
#include <tendril/dynamics/stiffness.h>

#include "bench/clock.h"

namespace tendril::bench {
namespace {

using Map = Eigen::Map<Eigen::VectorXd>;

Map values(N_Vector v) {
  return {N_VGetArrayPointer(v), N_VGetLength(v)};
}

/// The equations on (p, v) alone, without the work that System integrates too: its row would fill the
/// Jacobian. The Jacobian is exact, [0 1; -M^-1 K  -alpha - beta M^-1 K], but for how the directions of
/// viscous forces change.
class Equations {
 public:
  explicit Equations(const Problem& problem)
      : problem_(problem),
        flow_(problem),
        size_(6 * static_cast<Eigen::Index>(problem.system.node_count())),
        y_(problem.start.y),
        rate_(problem.start.y),
        work_(problem.system.make_workspace()) {}

  int rate(double t, N_Vector y, N_Vector out) {
    y_.head(size_) = values(y);
    if (!flow_(t, y_, rate_).ok()) return 1;  // SUNDIALS tries a shorter step
    values(out) = rate_.head(size_);
    return 0;
  }

  int jacobian(double t, N_Vector y, SUNMatrix out) {
    State at = problem_.start;
    at.time = t;
    at.y.head(size_) = values(y);
    if (!problem_.system.rebase(at, *work_).ok()) return 1;
    if (!elastic_stiffness(problem_.system, at, stiffness_, *work_).ok()) return 1;
    fill(out);
    return 0;
  }

  void accepted(double t, N_Vector y) {
    y_.head(size_) = values(y);
    flow_.accepted(t, y_);
  }

  /// Entries of the Jacobian, zeros among them included: KLU keeps the pattern it has seen first.
  sunindextype entries() const { return size_ * 3 * (2 * kReach + 1); }

  Eigen::Index size() const { return size_; }
  const Flow& flow() const { return flow_; }

 private:
  /// Column j of the positions: minus K over the mass below; of the velocities: 1 above, the damping below.
  void fill(SUNMatrix out) {
    sunindextype* columns = SUNSparseMatrix_IndexPointers(out);
    sunindextype* rows = SUNSparseMatrix_IndexValues(out);
    double* data = SUNSparseMatrix_Data(out);
    const Rod& rod = problem_.system.scene().rods[0];
    const Eigen::Index half = size_ / 2;
    sunindextype next = 0;
    const auto add = [&](Eigen::Index row, double value) {
      rows[next] = row;
      data[next++] = value;
    };
    for (Eigen::Index j = 0; j < size_; ++j) {
      columns[j] = next;
      const Eigen::Index column = j % half;
      if (column < 3) continue;  // the clamped node
      if (j >= half) {
        add(column, 1.0);
        add(half + column, -rod.mass_damping);
        continue;
      }
      const Eigen::Index node = column / 3;
      const Eigen::Index first = std::max<Eigen::Index>(3, 3 * (node - kReach));
      const Eigen::Index end = std::min(half, 3 * (node + kReach) + 3);
      double* at = data + next;
      for (Eigen::Index row = first; row < end; ++row) add(half + row, 0.0);
      for (Eigen::SparseMatrix<double>::InnerIterator it(stiffness_, column); it; ++it)
        if (it.row() >= first && it.row() < end)
          at[it.row() - first] = -it.value() / rod.mass[static_cast<std::size_t>(it.row() / 3)];
    }
    columns[size_] = next;
  }

  static constexpr Eigen::Index kReach = 2;  ///< nodes that one couples with on either side, without twist

  const Problem& problem_;
  Flow flow_;
  Eigen::Index size_;
  Eigen::VectorXd y_, rate_;
  System::WorkspacePtr work_;
  Eigen::SparseMatrix<double> stiffness_;
};

int rate_of(double t, N_Vector y, N_Vector out, void* user) {
  return static_cast<Equations*>(user)->rate(t, y, out);
}
int jacobian_of(double t, N_Vector y, N_Vector, SUNMatrix out, void* user, N_Vector, N_Vector, N_Vector) {
  return static_cast<Equations*>(user)->jacobian(t, y, out);
}

/// What every solver of the suite needs, let go in the right order.
struct Session {
  explicit Session(const Problem& problem) : equations(problem) {
    SUNContext_Create(nullptr, &context);
    y = N_VNew_Serial(equations.size(), context);
    values(y) = problem.start.y.head(equations.size());
  }
  ~Session() {
    if (solver) SUNLinSolFree(solver);
    if (matrix) SUNMatDestroy(matrix);
    N_VDestroy(y);
    SUNContext_Free(&context);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void make_linear_solver() {
    matrix = SUNSparseMatrix(equations.size(), equations.size(), equations.entries(), CSC_MAT, context);
    solver = SUNLinSol_KLU(y, matrix, context);
  }

  Equations equations;
  SUNContext context = nullptr;
  N_Vector y = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver solver = nullptr;
};

/// Steps on until the end, the cap or a failure.
/// \param step  one internal step, its flag negative on failure
template <class Step>
void drive(const Problem& problem, double cap, Session& session, const Step& step, Trial& out) {
  Deadline deadline(cap);
  double t = 0.0;
  while (t < problem.duration && !out.capped && out.failure.empty()) {
    const int flag = step(&t);
    if (flag < 0)
      out.failure = "gave up with flag " + std::to_string(flag);
    else
      session.equations.accepted(t, session.y);
    out.capped = deadline.passed();
  }
  out.reached = t;
}

Trial cvode(const Problem& problem, double tolerance, double cap, Session& session) {
  Trial out;
  void* memory = CVodeCreate(CV_BDF, session.context);
  session.make_linear_solver();
  CVodeInit(memory, rate_of, 0.0, session.y);
  CVodeSStolerances(memory, tolerance, tolerance);
  CVodeSetUserData(memory, &session.equations);
  CVodeSetLinearSolver(memory, session.solver, session.matrix);
  CVodeSetJacFn(memory, jacobian_of);
  CVodeSetStopTime(memory, problem.duration);
  CVodeSetErrFile(memory, nullptr);
  drive(
      problem, cap, session,
      [&](double* t) { return CVode(memory, problem.duration, session.y, t, CV_ONE_STEP); }, out);
  CVodeGetNumSteps(memory, &out.steps);
  CVodeFree(&memory);
  return out;
}

Trial erk(const Problem& problem, double tolerance, double cap, Session& session) {
  Trial out;
  void* memory = ERKStepCreate(rate_of, 0.0, session.y, session.context);
  ERKStepSStolerances(memory, tolerance, tolerance);
  ERKStepSetUserData(memory, &session.equations);
  ERKStepSetTableNum(memory, ARKODE_CASH_KARP_6_4_5);
  ERKStepSetStopTime(memory, problem.duration);
  ERKStepSetErrFile(memory, nullptr);
  drive(
      problem, cap, session,
      [&](double* t) { return ERKStepEvolve(memory, problem.duration, session.y, t, ARK_ONE_STEP); }, out);
  ERKStepGetNumSteps(memory, &out.steps);
  ERKStepFree(&memory);
  return out;
}

Trial dirk(const Problem& problem, double tolerance, double cap, Session& session) {
  Trial out;
  void* memory = ARKStepCreate(nullptr, rate_of, 0.0, session.y, session.context);
  session.make_linear_solver();
  ARKStepSStolerances(memory, tolerance, tolerance);
  ARKStepSetUserData(memory, &session.equations);
  ARKStepSetLinearSolver(memory, session.solver, session.matrix);
  ARKStepSetJacFn(memory, jacobian_of);
  ARKStepSetStopTime(memory, problem.duration);
  ARKStepSetErrFile(memory, nullptr);
  drive(
      problem, cap, session,
      [&](double* t) { return ARKStepEvolve(memory, problem.duration, session.y, t, ARK_ONE_STEP); }, out);
  ARKStepGetNumSteps(memory, &out.steps);
  ARKStepFree(&memory);
  return out;
}

using Method = Trial (*)(const Problem&, double, double, Session&);

template <Method method>
Trial run(const Problem& problem, double tolerance, double cap) {
  if (problem.system.twist_count() > 0) {
    Trial out;
    out.tolerance = tolerance;
    out.failure = "not run on rods with twist";
    return out;
  }
  const double begin = cpu_seconds();
  Session session(problem);
  Trial out = method(problem, tolerance, cap, session);
  out.seconds = cpu_seconds() - begin;
  out.tolerance = tolerance;
  out.evaluations = session.equations.flow().evaluations();
  out.p = values(session.y).head(session.equations.size() / 2);
  return out;
}

}  // namespace

std::vector<Solver> sundials_solvers() {
  return {{"ARKODE CK", run<erk>}, {"ARKODE DIRK", run<dirk>}, {"CVODE BDF", run<cvode>}};
}

std::string sundials_version() {
  return "SUNDIALS " SUNDIALS_VERSION " with KLU and the exact Jacobian";
}

}  // namespace tendril::bench

#else

namespace tendril::bench {

std::vector<Solver> sundials_solvers() {
  return {};
}

std::string sundials_version() {
  return "SUNDIALS: absent";
}

}  // namespace tendril::bench

#endif
