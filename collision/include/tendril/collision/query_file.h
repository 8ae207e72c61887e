#pragma once

#include <tendril/base/export.h>
#include <tendril/collision/continuous.h>

#include <string>
#include <string_view>
#include <vector>

/// Files of continuous queries with known answers.
///
/// Straight paths: the format of the public benchmark [Wang et al. 2021], byte for byte. Eight rows a query,
/// the four vertices at t = 0, then at t = 1; seven columns a row, numerator and denominator of x, y and z,
/// and the answer, 1 where the features meet. Cubic paths: sixteen rows, the four vertices' first
/// time-control points, then their second, third and fourth; eleven columns, with the numerators and
/// denominators of a bracket of the first time of meeting (0 and 1 where there is none). Which features a
/// file is about, its name or folder says.
///
/// Coordinates are doubles and written exactly: denominators are powers of two, fractions are in lowest
/// terms, and zero has no sign.
namespace tendril::collision {

/// A query and its answer.
template <int Degree>
struct KnownQuery {
  Paths<Degree> paths;  ///< of degree 1 or 3
  bool meets = false;   ///< the answer
  double from = 0.0;    ///< bracket of the first meeting, of cubic paths alone
  double to = 1.0;      ///< its other end
};

/// Throws InvalidInput ("file.csv:12") on a row with another number of columns, a column that is no integer,
/// a fraction that is no double, answers that differ within a query, and a query that is cut short.
/// \param text   the whole file
/// \param place  its name, for errors
template <int Degree>
TENDRIL_COLLISION_API std::vector<KnownQuery<Degree>> read_queries(std::string_view text,
                                                                   const std::string& place);

/// What read_queries reads, with \n at the end of each row.
/// \param queries  finite, else InvalidInput
template <int Degree>
TENDRIL_COLLISION_API std::string write_queries(const std::vector<KnownQuery<Degree>>& queries);

}  // namespace tendril::collision
