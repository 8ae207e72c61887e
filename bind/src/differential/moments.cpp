#include "moments.h"

#include <cstring>

namespace tendril::bind {
namespace {

constexpr std::size_t kLanes = 8;
typedef double Lanes __attribute__((vector_size(kLanes * sizeof(double))));

/// Forces on what a point is made of: the velocity z and the scaled offset.
struct Pulled {
  Triple<double> z, d;
};

/// The point is c + u X + v Y + w Z with z = c', x = d x z, X = x / |x|, Z = z / |z|, Y = Z x X. Under a
/// change of z and d the force f does the work
///
///   f . (u dX + v (dZ x X + Z x dX) + w dZ) = g_x . dX + g_z . dZ,
///   g_x = u f + v (f x Z),   g_z = w f + v (X x f),
///
/// by the cyclic symmetry of the triple product. Of a unit vector, dX = (dx - X (X . dx)) / |x|, so with h_x
/// the part of g_x across X over |x|, and h_z likewise, the work is h_x . dx + h_z . dz. At last dx = dd x z
/// + d x dz: z x h_x is the force on d, and h_z + h_x x d that on z.
/// \param fu, fv, fw  sums of u f, v f and w f
template <int P>
TENDRIL_INLINE Pulled pull(const Piece<double>& piece, double s, const Triple<double>& fu,
                           const Triple<double>& fv, const Triple<double>& fw) {
  const Moving<double> at = moving<double, P>(piece, s);
  const Lengths<double> inverse = inverse_lengths(at);
  const Triple<double> x = inverse.x * at.x;
  const Triple<double> z = inverse.z * at.z;
  const Triple<double> gx = fu + cross(fv, z);
  const Triple<double> gz = fw + cross(x, fv);
  const Triple<double> hx = inverse.x * (gx - dot(x, gx) * x);
  const Triple<double> hz = inverse.z * (gz - dot(z, gz) * z);
  const Triple<double> on_z = hz + cross(hx, at.offset);
  const Triple<double> on_d = cross(at.z, hx);
  const auto kept = [&](double value) { return at.sound > 0.5 ? value : 0.0; };
  return {{kept(on_z.x), kept(on_z.y), kept(on_z.z)}, {kept(on_d.x), kept(on_d.y), kept(on_d.z)}};
}

/// Columns of a chunk: filled with zeros up to a multiple of the lanes.
struct Scratch {
  alignas(64) double s[kMomentChunk];
  alignas(64) double f[3][kMomentChunk], z[3][kMomentChunk], d[3][kMomentChunk];
};

template <int P>
TENDRIL_INLINE void pull_all(const Piece<double>& piece, const RecordsView<double>& records,
                             std::size_t count, Scratch& to) {
  const double* __restrict u = records.u, * __restrict v = records.v, * __restrict w = records.w;
  const Piece<double> local = piece;
  TENDRIL_LOOP
  for (std::size_t i = 0; i < count; ++i) {
    const Triple<double> f{to.f[0][i], to.f[1][i], to.f[2][i]};
    const Pulled at = pull<P>(local, to.s[i], u[i] * f, v[i] * f, w[i] * f);
    to.z[0][i] = at.z.x;
    to.z[1][i] = at.z.y;
    to.z[2][i] = at.z.z;
    to.d[0][i] = at.d.x;
    to.d[1][i] = at.d.y;
    to.d[2][i] = at.d.z;
  }
}

/// By reference: how vectors are returned depends on the vector unit.
TENDRIL_INLINE void load(const double* from, Lanes& to) {
  std::memcpy(&to, from, sizeof to);
}

TENDRIL_INLINE double sum(const Lanes& a) {
  return ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7]));
}

/// Coefficient j of c feels s^j f and, through z = dc/ds, j s^(j - 1) times the force on z; that of d feels
/// s^j times the force on d.
template <int P, int J>
TENDRIL_INLINE void raise(const Lanes& s, const Lanes& sf, const Lanes& z, const Lanes& power, Lanes* c) {
  if constexpr (J <= P) {
    c[J] += power * (sf + static_cast<double>(J) * z);
    raise<P, J + 1>(s, sf, z, power * s, c);
  }
}

template <int P, int J>
TENDRIL_INLINE void raise(const Lanes& s, const Lanes& now, Lanes* d) {
  if constexpr (J <= P) {
    d[J] += now;
    raise<P, J + 1>(s, now * s, d);
  }
}

template <int P>
TENDRIL_INLINE void sum_moments(const Scratch& from, std::size_t k, std::size_t padded, Moments& to) {
  Lanes c[P + 1] = {}, d[P + 1] = {};
  for (std::size_t i = 0; i < padded; i += kLanes) {
    Lanes s, f, on_z, on_d;
    load(from.s + i, s);
    load(from.f[k] + i, f);
    load(from.z[k] + i, on_z);
    load(from.d[k] + i, on_d);
    c[0] += f;
    raise<P, 1>(s, s * f, on_z, Lanes{1, 1, 1, 1, 1, 1, 1, 1}, c);
    raise<P, 0>(s, on_d, d);
  }
  for (std::size_t j = 0; j <= P; ++j) {
    to.c[j][k] += sum(c[j]);
    to.d[j][k] += sum(d[j]);
  }
}

template <int P>
struct AddMoments {
  static TENDRIL_INLINE void run(const Piece<double>& piece, const RecordsView<double>& records,
                                 const ColumnsView<const double>& force, std::size_t count, Moments* to) {
    Scratch scratch;
    const std::size_t padded = (count + kLanes - 1) / kLanes * kLanes;
    const auto copy = [&](const double* from, double* column) {
      std::memcpy(column, from, count * sizeof(double));
      for (std::size_t i = count; i < padded; ++i) column[i] = 0.0;
    };
    copy(records.s, scratch.s);
    copy(force.x, scratch.f[0]);
    copy(force.y, scratch.f[1]);
    copy(force.z, scratch.f[2]);
    pull_all<P>(piece, records, count, scratch);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = count; i < padded; ++i) scratch.z[k][i] = scratch.d[k][i] = 0.0;
      sum_moments<P>(scratch, k, padded, *to);
    }
  }
};

/// Coefficients of one s: see raise().
void add_at(double s, int degree, const Triple<double>& f, const Pulled& on, Moments& to) {
  const double force[3]{f.x, f.y, f.z}, z[3]{on.z.x, on.z.y, on.z.z}, d[3]{on.d.x, on.d.y, on.d.z};
  double power = 1.0, before = 0.0;  // s^j, j s^(j - 1)
  for (std::size_t j = 0; j <= static_cast<std::size_t>(degree); ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      to.c[j][k] += power * force[k] + before * z[k];
      to.d[j][k] += power * d[k];
    }
    before = before * s + power;
    power *= s;
  }
}

}  // namespace

/// The map is A = R R0^T, b = c - A o with the frames R posed and R0 at rest: the sums over f of u f, v f
/// and w f, of (u, v, w) = R0^T (q - o), are the columns of (sum f q^T - sum f o^T) R0.
void add_moments(const AxisNode& node, const Piece<double>& piece, const MapForces& forces, Moments& to) {
  Mat3 product;
  Vec3 force;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) product(i, j) = forces.row[i][j];
    force[i] = forces.row[i][3];
  }
  const Mat3 by = (product - force * node.origin.transpose()) * node.frame;
  const auto column = [&](int k) { return Triple<double>{by(0, k), by(1, k), by(2, k)}; };
  const Turn turn = turn_at(piece, node.s);  // in the frame before the turn, coordinates are turned instead
  const Triple<double> fu = turn.cosine * column(0) - turn.sine * column(1);
  const Triple<double> fv = turn.sine * column(0) + turn.cosine * column(1);
  const Pulled on = for_degree(piece.degree, [&](auto degree) {
    return pull<decltype(degree)::value>(piece, node.s, fu, fv, column(2));
  });
  add_at(node.s, piece.degree, {force.x(), force.y(), force.z()}, on, to);
}

Moments& Moments::operator+=(const Moments& other) {
  for (std::size_t j = 0; j < kMostTerms; ++j)
    for (std::size_t k = 0; k < 3; ++k) {
      c[j][k] += other.c[j][k];
      d[j][k] += other.d[j][k];
    }
  return *this;
}

void add_moments_on(VectorUnit unit, const Piece<double>& piece, const RecordsView<double>& records,
                    const ColumnsView<const double>& force, std::size_t count, Moments& to) {
  for_degree(piece.degree, [&](auto degree) {
    constexpr int p = decltype(degree)::value;
    OnUnits<AddMoments<p>>::run(unit, piece, records, force, count, &to);
  });
}

void add_moments(const Piece<double>& piece, const RecordsView<double>& records,
                 const ColumnsView<const double>& force, std::size_t count, Moments& to) {
  add_moments_on(widest_unit(), piece, records, force, count, to);
}

}  // namespace tendril::bind
