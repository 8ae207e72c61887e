#include <tendril/base/error.h>
#include <tendril/bind/binding.h>
#include <tendril/bind/bindingf.h>

#include <string>

#include "evaluator.h"

namespace tendril::bind {
namespace {

void require(const char* what, std::size_t given, std::size_t expected) {
  if (given != expected)
    throw InvalidInput(what, std::to_string(given) + " points", std::to_string(expected));
}

template <class T>
ColumnsView<T> view(const Columns<T>& out, std::size_t size) {
  require("out.x", out.x.size(), size);
  require("out.y", out.y.size(), size);
  require("out.z", out.z.size(), size);
  return {out.x.data(), out.y.data(), out.z.data()};
}

/// All points in the mesh's order: an update has the same bits, at a tenth of the price.
bool are_all(std::span<const std::uint32_t> points, std::size_t size) {
  if (points.size() != size) return false;
  for (std::size_t i = 0; i < size; ++i)
    if (points[i] != i) return false;
  return true;
}

Evaluator<double> evaluator(const BindingLayout& layout, std::span<const CurvePair> posed) {
  return {layout, layout.numbers, posed};
}

}  // namespace

void Binding::update(std::span<const CurvePair> posed, MutablePoints out, int threads) const {
  require("out", out.size(), size());
  require_threads(threads);
  evaluator(*layout_, posed).update(out.data(), threads);
}

void Binding::update(const CurvePair& posed, MutablePoints out, int threads) const {
  update({&posed, 1}, out, threads);
}

void Binding::update(std::span<const CurvePair> posed, const Columns<double>& out, int threads) const {
  require_threads(threads);
  evaluator(*layout_, posed).update(view(out, size()), threads);
}

Vec3 Binding::at(std::span<const CurvePair> posed, std::size_t point) const {
  const Triple<double> p = evaluator(*layout_, posed).one(point);
  return {p.x, p.y, p.z};
}

Vec3 Binding::at(const CurvePair& posed, std::size_t point) const {
  return at({&posed, 1}, point);
}

void Binding::at(std::span<const CurvePair> posed, std::span<const std::uint32_t> points,
                 MutablePoints out) const {
  require("out", out.size(), points.size());
  if (are_all(points, size())) return update(posed, out);
  evaluator(*layout_, posed).some(points, out.data());
}

struct Bindingf::Numbers : BindingLayout::Numbers<float> {};

Bindingf::Bindingf(const Binding& binding) : binding_(binding) {
  const BindingLayout::Numbers<double>& exact = binding.layout_->numbers;
  auto numbers = std::make_shared<Numbers>();
  numbers->nearest = Records<float>(exact.nearest);
  numbers->share.assign(exact.share.begin(), exact.share.end());
  for (const Triple<double>& p : exact.place)
    numbers->place.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
  numbers_ = std::move(numbers);
}

void Bindingf::update(std::span<const CurvePair> posed, std::span<Eigen::Vector3f> out, int threads) const {
  require("out", out.size(), size());
  require_threads(threads);
  Evaluator<float>(*binding_.layout_, *numbers_, posed).update(out.data(), threads);
}

void Bindingf::update(std::span<const CurvePair> posed, const Columns<float>& out, int threads) const {
  require_threads(threads);
  Evaluator<float>(*binding_.layout_, *numbers_, posed).update(view(out, size()), threads);
}

Eigen::Vector3f Bindingf::at(std::span<const CurvePair> posed, std::size_t point) const {
  const Triple<float> p = Evaluator<float>(*binding_.layout_, *numbers_, posed).one(point);
  return {p.x, p.y, p.z};
}

}  // namespace tendril::bind
