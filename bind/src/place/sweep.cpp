#include "sweep.h"

namespace tendril::bind {
namespace {

template <class T, int P, bool Off>
struct SweepSpan {
  static TENDRIL_INLINE bool run(const Piece<T>& piece, const RecordsView<T>& records,
                                 const ColumnsView<T>& out, std::size_t count) {
    const T *__restrict s = records.s, *__restrict u = records.u, *__restrict v = records.v,
            *__restrict w = records.w;
    T* __restrict x = out.x, * __restrict y = out.y, * __restrict z = out.z;
    const Piece<T> local = piece;
    Flag<T> left = 0;
    TENDRIL_LOOP
    for (std::size_t i = 0; i < count; ++i) {
      const Evaluated<T> evaluated = evaluate<T, P, Off>(local, s[i], u[i], v[i], Off ? w[i] : T(0));
      x[i] = evaluated.point.x;
      y[i] = evaluated.point.y;
      z[i] = evaluated.point.z;
      left |= evaluated.fault;
    }
    return left != 0;
  }
};

}  // namespace

template <class T>
bool sweep_on(VectorUnit unit, const Piece<T>& piece, bool off, const RecordsView<T>& records,
              const ColumnsView<T>& out, std::size_t count) {
  return for_degree(piece.degree, [&](auto degree) {
    constexpr int p = decltype(degree)::value;
    return off ? OnUnits<SweepSpan<T, p, true>>::run(unit, piece, records, out, count)
               : OnUnits<SweepSpan<T, p, false>>::run(unit, piece, records, out, count);
  });
}

template <class T>
bool sweep(const Piece<T>& piece, bool off, const RecordsView<T>& records, const ColumnsView<T>& out,
           std::size_t count) {
  return sweep_on(widest_unit(), piece, off, records, out, count);
}

template <class T>
Evaluated<T> evaluate_one(const Piece<T>& piece, bool off, const RecordsView<T>& at) {
  return for_degree(piece.degree, [&](auto degree) {
    constexpr int p = decltype(degree)::value;
    return off ? evaluate<T, p, true>(piece, *at.s, *at.u, *at.v, *at.w)
               : evaluate<T, p, false>(piece, *at.s, *at.u, *at.v, T(0));
  });
}

template bool sweep(const Piece<double>&, bool, const RecordsView<double>&, const ColumnsView<double>&,
                    std::size_t);
template bool sweep(const Piece<float>&, bool, const RecordsView<float>&, const ColumnsView<float>&,
                    std::size_t);
template bool sweep_on(VectorUnit, const Piece<double>&, bool, const RecordsView<double>&,
                       const ColumnsView<double>&, std::size_t);
template Evaluated<double> evaluate_one(const Piece<double>&, bool, const RecordsView<double>&);
template bool sweep_on(VectorUnit, const Piece<float>&, bool, const RecordsView<float>&,
                       const ColumnsView<float>&, std::size_t);
template Evaluated<float> evaluate_one(const Piece<float>&, bool, const RecordsView<float>&);

}  // namespace tendril::bind
