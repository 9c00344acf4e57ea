// Unions of intervals, one a lane.
#if defined(AFTERSHADE_CORE_AO_INTERVAL_UNION_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_AO_INTERVAL_UNION_H
#undef AFTERSHADE_CORE_AO_INTERVAL_UNION_H
#else
#define AFTERSHADE_CORE_AO_INTERVAL_UNION_H
#endif
#include <vector>

#include "core/simd/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

/// [from, to], from < to, inside [-1, 1].
struct Interval {
  lanes::HWY_NAMESPACE::Float from, to;
};
/// Empty; it touches nothing.
inline Interval no_interval() { return {2.0F, 2.0F}; }
inline Interval select(lanes::HWY_NAMESPACE::Mask m, const Interval& yes, const Interval& no) {
  using lanes::HWY_NAMESPACE::select;
  return {select(m, yes.from, no.from), select(m, yes.to, no.to)};
}

/// Disjoint intervals in no order, among them empty ones. Keeps its memory when it is cleared.
class Intervals {
 public:
  void clear() { size_ = 0; }
  int size() const { return size_; }
  Interval operator[](int i) const {
    using lanes::HWY_NAMESPACE::load;
    return {load(place(i)), load(place(i) + kLanes)};
  }

  /// Unites what all hold with `added`. What it touches goes into the first such place or an empty one; only intervals
  /// that touch `added` itself are joined, since they are apart from each other.
  void unite(const Interval& added) {
    using namespace lanes::HWY_NAMESPACE;
    Mask homeless = added.from <= 1.0F;
    if (!any(homeless)) return;
    Interval joined = added;
    for (int i = 0; i < size_; ++i) {
      const Interval old = (*this)[i];
      const Mask touch = touches(old, added);
      joined.from = select(touch, min(joined.from, old.from), joined.from);
      joined.to = select(touch, max(joined.to, old.to), joined.to);
    }
    for (int i = 0; i < size_; ++i) {
      const Interval old = (*this)[i];
      const Mask vacant = touches(old, added) | (old.from > 1.0F), moves_in = homeless & vacant;
      put(i, HWY_NAMESPACE::select(moves_in, joined, HWY_NAMESPACE::select(vacant, no_interval(), old)));
      homeless = homeless & !vacant;
    }
    if (!any(homeless)) return;
    if (static_cast<size_t>(2 * (size_ + 1) * kLanes) > values_.size()) values_.resize(2 * values_.size() + 8 * kLanes);
    put(size_++, HWY_NAMESPACE::select(homeless, joined, no_interval()));
  }

 private:
  static constexpr int kLanes = lanes::HWY_NAMESPACE::kLanes;
  static lanes::HWY_NAMESPACE::Mask touches(const Interval& a, const Interval& b) {
    return (a.to >= b.from) & (a.from <= b.to);
  }
  const float* place(int i) const { return values_.data() + 2 * i * kLanes; }
  void put(int i, const Interval& interval) {
    float* at = values_.data() + 2 * i * kLanes;
    lanes::HWY_NAMESPACE::store(at, interval.from);
    lanes::HWY_NAMESPACE::store(at + kLanes, interval.to);
  }
  std::vector<float> values_;
  int size_ = 0;
};

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
