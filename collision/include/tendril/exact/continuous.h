#pragma once

#include <tendril/base/export.h>
#include <tendril/collision/continuous.h>

namespace tendril::exact {

/// The continuous test without doubt: first in doubles (collision::first_meeting), and what those leave open
/// in integers made of the same doubles.
///
/// Complete: `hit` or `free` for every finite query, of whatever size, degenerate features and motion in one
/// plane included, with the first meeting in a bracket at most 2^-40 wide (from == to where the time is a
/// double and was found to be). `undecided` only where a coordinate is not finite.
///
/// The coordinates, each axis times a power of two of its own, are integers; the determinant of the three
/// relative paths is a polynomial with integer Bernstein coefficients. Its roots in [0, 1] are isolated by
/// Descartes' rule and halving [Collins and Akritas 1976], where doubles do not prove the features apart, and
/// at each in turn the signs of the weights, polynomials of degree 2 Degree, tell whether the features meet;
/// where such a sign is zero, common divisors show it. Where the determinant is zero throughout, the roots of
/// the weights take its place, and where those are, the roots of coordinates. The integers take about 5 us
/// for a straight query, 10 us for a cubic one, and more with the square of the powers of two between the
/// largest coordinate and the smallest.
/// \param features  what the vertices are
/// \param paths     of degree 1 or 3
template <int Degree>
TENDRIL_EXACT_API collision::FirstMeeting first_meeting(collision::Features features,
                                                        const collision::Paths<Degree>& paths);

/// The same by integers alone.
/// \param features  what the vertices are
/// \param paths     of degree 1 or 3
template <int Degree>
TENDRIL_EXACT_API collision::FirstMeeting first_meeting_in_integers(collision::Features features,
                                                                    const collision::Paths<Degree>& paths);

}  // namespace tendril::exact
