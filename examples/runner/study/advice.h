#pragma once

#include "study/ladder.h"

namespace tendril::runner {

/// The cheapest run that meets the target and controls its own error, in a sentence that can be put into the
/// scene file; the automatic choice when it costs little more. Cheaper runs of fixed step are named beside
/// it: that their step fits is known from this report only. When none meets the target, which came closest.
Advice advise(const Results& results);

}  // namespace tendril::runner
