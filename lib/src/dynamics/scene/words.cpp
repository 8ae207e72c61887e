#include "words.h"

namespace tendril {

const char* describe(Evaluation::Outcome outcome) {
  switch (outcome) {
    case Evaluation::Outcome::ok:
      return "error above the tolerance";
    case Evaluation::Outcome::zero_edge:
      return "edge of length 0";
    case Evaluation::Outcome::fold_back:
      return "edges folded back by half a turn";
    case Evaluation::Outcome::turned_too_far:
      return "tangent or body turned more than 126 degrees";
    case Evaluation::Outcome::not_finite:
      return "a number that is not finite";
    case Evaluation::Outcome::not_converged:
      return "the equations of the implicit step were not solved: a shorter step may";
    case Evaluation::Outcome::refused:
      return "a force refuses the state";
    case Evaluation::Outcome::coupled_too_far:
      return "forces couple more nodes than elimination takes: explicit steps need none";
  }
  return "";
}

}  // namespace tendril
