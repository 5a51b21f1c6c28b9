/// Contacts of a whole world in the smallest number of rows: in each lane, row k contains the k-th
/// contact of the lane, on any body. In contrast, slots are assigned per body (stage_collide.inl).
/// On a plane, the robots of all lanes have contacts at the same bodies. On hills they differ, so
/// rows per body would be as many as the contacts of all lanes together.
///
/// A packed contact has a link to each body that any lane needs. In other lanes, the link is zero
/// and adds exactly zero.
#pragma once

#include "sim/data/rows.h"

namespace taut::sim {

/// Contacts in the slots of the bodies, not packed.
template <class W>
class ContactsInSlots {
 public:
  static constexpr bool kPacked = false;
  ContactsInSlots(const View& m, Scratch<W>& work) noexcept : m_(m), work_(work) {}
  template <class F>
  TAUT_INLINE void ForEach(F&& f) noexcept {
    for (int b = 0; b < m_.body_count; ++b) {
      for (int k = 0; k < work_.contact_count[b]; ++k) {
        f(work_.contacts[m_.first_slot[b] + k]);
      }
    }
  }
  template <class M>
  void Finish(M) noexcept {}

 private:
  const View& m_;
  Scratch<W>& work_;
};

template <class W>
class PackedContacts {
  using M = MaskOf<W>;
  using Packed = typename DualMemory<W>::Packed;

 public:
  static constexpr bool kPacked = true;
  /// Packs the contacts of `lanes`. The contacts of each lane must fit into memory.
  PackedContacts(const View& m, Scratch<W>& work, M lanes) noexcept
      : m_(m), work_(work), packed_(work.dual.packed), lanes_(lanes) {
    ForEachPlace([&](const Contact<W, 1>& from, int row, M here) {
      Put(from, packed_[row], row == count_, here);
      if (row == count_) ++count_;
    });
  }
  template <class F>
  TAUT_INLINE void ForEach(F&& f) noexcept {
    for (int k = 0; k < count_; ++k) f(packed_[k]);
  }
  /// Copies impulses back to the slots in the lanes `solved`.
  void Finish(M solved) noexcept {
    ForEachPlace([&](Contact<W, 1>& to, int row, M here) {
      for (int r = 0; r < 3; ++r) to.l[r] = Select(here & solved, packed_[row].l[r], to.l[r]);
    });
  }

 private:
  /// Calls f(contact, row, lanes with the contact in this row), in the order of the slots.
  template <class F>
  TAUT_INLINE void ForEachPlace(F&& f) noexcept {
    const W one = W::Splat(1.0), zero = W::Splat(0.0);
    W used = zero;
    int most = 0;
    for (int b = 0; b < m_.body_count; ++b) {
      for (int k = 0; k < work_.contact_count[b]; ++k) {
        Contact<W, 1>& c = work_.contacts[m_.first_slot[b] + k];
        const M live = lanes_ & (c.live > zero);
        if (!Any(live)) continue;
        const int last = most;
        for (int row = W::kLanes == 1 ? last : 0; row <= last; ++row) {
          const M here = live & (used == W::Splat(row));
          if (!Any(here)) continue;
          f(c, row, here);
          if (row == most) ++most;
        }
        used += Select(live, one, zero);
      }
    }
  }

  static void Put(const Contact<W, 1>& from, Packed& to, bool first, M here) noexcept {
    const W zero = W::Splat(0.0);
    const V3<W> none{zero, zero, zero};
    if (first) {
      // Lanes without this contact get harmless values.
      to.TakeLaw(from, [](const W& x, const W&) { return x; });
      to.live = zero;
      for (W& l : to.l) l = zero;
      to.link_count = 0;
    }
    to.TakeLaw(from, [here](const W& x, const W& old) { return Select(here, x, old); });
    const Link<W, 3>& a = from.links[0];
    const bool known = to.link_count > 0 && to.links[to.link_count - 1].body == a.body;
    if (!known) ++to.link_count;
    Link<W, 3>& link = to.links[to.link_count - 1];
    link.body = a.body;
    link.inv_mass = a.inv_mass;
    for (int r = 0; r < 3; ++r) {
      link.lin[r] = Select3(here, a.lin[r], known ? link.lin[r] : none);
      link.ang[r] = Select3(here, a.ang[r], known ? link.ang[r] : none);
      link.turn[r] = Select3(here, a.turn[r], known ? link.turn[r] : none);
    }
  }

  const View& m_;
  Scratch<W>& work_;
  Packed* packed_;
  M lanes_;
  int count_ = 0;
};

}  // namespace taut::sim
