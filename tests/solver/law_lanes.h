/// Evaluation of all functions of a law for plain doubles, one world per row: the same source for
/// every number of lanes. Without the standard library, because files compiled for other
/// instruction sets include it and must share no function with the rest.
#pragma once

#include "sim/constraint/cable_row.h"
#include "sim/constraint/contact_point.h"

namespace taut::test {

/// Reads the doubles of lane i: [i * stride], [i * stride + 1] ...
template <class W>
struct LaneReader {
  const double* at;
  int stride;

  W Next() noexcept {
    W x = W::Splat(0.0);
    for (int i = 0; i < W::kLanes; ++i) x.Set(i, at[i * stride]);
    ++at;
    return x;
  }
  simd::V3<W> Next3() noexcept {
    const W x = Next(), y = Next();
    return {x, y, Next()};
  }
};

template <class W>
struct LaneWriter {
  double* at;
  int stride;

  void Put(W x) noexcept {
    for (int i = 0; i < W::kLanes; ++i) at[i * stride] = x[i];
    ++at;
  }
};

/// Reads a link of R rows: inverse mass, inverse inertia (xx yy zz xy xz yz), directions, arm.
template <class W, int R>
sim::Link<W, R> ReadLink(LaneReader<W>& in) noexcept {
  sim::Link<W, R> link;
  link.inv_mass = in.Next();
  simd::S3<W> inv_inertia;
  W* const entries[] = {&inv_inertia.xx, &inv_inertia.yy, &inv_inertia.zz,
                        &inv_inertia.xy, &inv_inertia.xz, &inv_inertia.yz};
  for (W* const x : entries) *x = in.Next();
  for (int r = 0; r < R; ++r) link.lin[r] = in.Next3();
  const simd::V3<W> arm = in.Next3();
  for (int r = 0; r < R; ++r) {
    link.ang[r] = Cross(arm, link.lin[r]);
    link.turn[r] = inv_inertia * link.ang[r];
  }
  return link;
}

template <int R>
inline constexpr int kLinkNumbers = 10 + 3 * R;
inline constexpr int kContactNumbers = 8 + 2 * kLinkNumbers<3>;
inline constexpr int kCableNumbers = 8 + 2 * kLinkNumbers<1>;

template <class W>
sim::ContactPoint<W, 2> ReadContact(LaneReader<W>& in, bool one_direction,
                                    int link_count) noexcept {
  sim::ContactPoint<W, 2> c;
  c.live = in.Next();
  c.mu = in.Next();
  for (W& x : c.bias) x = in.Next();
  for (W& x : c.l) x = in.Next();
  for (int i = 0; i < 2; ++i) {
    c.links[i] = ReadLink<W, 3>(in);
    c.links[i].body = i;
  }
  c.one_direction = one_direction;
  c.link_count = link_count;
  c.FinishMasses();
  return c;
}

template <class W>
sim::CableRow<W> ReadCable(LaneReader<W>& in, sim::Link<W, 1>* links) noexcept {
  sim::CableRow<W> c;
  c.live = in.Next();
  const W start = in.Next(), end = in.Next(), spring = in.Next(), damper = in.Next();
  c.SetLaw(start, end, spring, damper, in.Next());
  c.upper = in.Next();
  c.l[0] = in.Next();
  for (int i = 0; i < 2; ++i) {
    links[i] = ReadLink<W, 1>(in);
    links[i].body = i;
  }
  c.link_count = 2;
  c.links = links;
  c.FinishMasses();
  return c;
}

/// Numbers of inputs (u, center, e, share) and results of a law of R rows.
template <int R>
inline constexpr int kQuestionNumbers = 2 * R + 2;
template <int R>
inline constexpr int kAnswerNumbers = 4 * R* R + 4 * R + 1;

template <class W, class Law>
void Ask(const Law& law, LaneReader<W>& in, LaneWriter<W>& out) noexcept {
  constexpr int R = Law::kRows;
  W u[R], center[R], projected[R], l[R], g[R * R];
  for (W& x : u) x = in.Next();
  for (W& x : center) x = in.Next();
  const W e = in.Next(), share = in.Next();
  auto branch = law.Project(u, center, e, projected);
  for (const W x : projected) out.Put(x);
  law.ProjectFrozen(u, center, e, projected, l);
  for (const W x : l) out.Put(x);
  law.Derivative(branch, e, g);
  for (const W x : g) out.Put(x);
  law.Stiffen(branch, share, g);
  for (const W x : g) out.Put(x);
  branch = law.BranchOf(u, center);
  out.Put(law.Residual(branch, u, center));
  sim::LinearLaw<W, R> linear;
  law.Linearize(branch, u, center, e, linear);
  for (int i = 0; i < R; ++i) {
    for (int j = 0; j < R; ++j) out.Put(linear.A[i][j]), out.Put(linear.S[i][j]);
    out.Put(linear.r[i]);
  }
  for (int r = 0; r < R; ++r) l[r] = center[r];
  law.Clamp(l);
  for (const W x : l) out.Put(x);
}

/// Evaluates W::kLanes contacts in SIMD lanes, or cables.
template <class W>
void AskContacts(const double* in, double* out, bool one_direction) noexcept {
  LaneReader<W> from{in, kContactNumbers + kQuestionNumbers<3>};
  LaneWriter<W> to{out, kAnswerNumbers<3>};
  Ask(ReadContact(from, one_direction, 2), from, to);
}
template <class W>
void AskCables(const double* in, double* out) noexcept {
  LaneReader<W> from{in, kCableNumbers + kQuestionNumbers<1>};
  LaneWriter<W> to{out, kAnswerNumbers<1>};
  sim::Link<W, 1> links[2];
  Ask(ReadCable(from, links), from, to);
}

using AskContactsFunction = void(const double* in, double* out, bool one_direction) noexcept;
using AskCablesFunction = void(const double* in, double* out) noexcept;
extern AskContactsFunction* const kAskFourContacts;
extern AskContactsFunction* const kAskEightContacts;
extern AskCablesFunction* const kAskFourCables;
extern AskCablesFunction* const kAskEightCables;

}  // namespace taut::test
