/// The linear system of Newton's method in the velocities of bodies: 6x6 blocks, one a pair of
/// bodies that act on each other, factored in the order of the bodies (docs/theory/contact.md,
/// eq. 21, 25). No pivots: M + J^T G J is positive definite but for the coupling of friction to the
/// normal impulse, and a step that a bad pivot spoils is refused by what judges it.

namespace taut::sim {

template <class Num>
class BodyMatrix {
  static constexpr int kBlock = kDofs * kDofs;

 public:
  BodyMatrix(const BlockPattern& pattern, Num* blocks) noexcept : p_(pattern), a_(blocks) {}

  /// M on the diagonal, else 0. `symmetric`: only the lower triangle is kept and filled.
  template <class Bodies>
  void Start(const Bodies* bodies, bool symmetric) noexcept {
    symmetric_ = symmetric;
    const Num zero = Num::Splat(0.0);
    const int used = symmetric ? p_.lower_count : p_.block_count;
    for (int i = 0; i < kBlock * used; ++i) a_[i] = zero;
    for (int b = 0; b < p_.count; ++b) {
      Num* const d = At(b, b);
      const auto& body = bodies[b];
      for (int i = 0; i < 3; ++i) d[7 * i] = body.mass;
      d[21] = body.inertia.xx, d[28] = body.inertia.yy, d[35] = body.inertia.zz;
      d[27] = d[22] = body.inertia.xy;
      d[33] = d[23] = body.inertia.xz;
      d[34] = d[29] = body.inertia.yz;
    }
  }

  /// += J^T G J of one constraint; G: R x R, row by row.
  template <class Law>
  void Add(const Law& law, const Num* G) noexcept {
    constexpr int R = Law::kRows;
    for (int k = 0; k < law.link_count; ++k) {
      Num j[R][kDofs], gj[R][kDofs];
      Unpack(law.links[k], j);
      for (int r = 0; r < R; ++r) {
        for (int c = 0; c < kDofs; ++c) {
          Num sum = G[R * r] * j[0][c];
          for (int q = 1; q < R; ++q) sum += G[R * r + q] * j[q][c];
          gj[r][c] = sum;
        }
      }
      for (int i = 0; i < law.link_count; ++i) {
        const int row = law.links[i].body, column = law.links[k].body;
        if (symmetric_ && row < column) continue;
        Num* const block = At(row, column);
        Num ji[R][kDofs];
        Unpack(law.links[i], ji);
        for (int r = 0; r < R; ++r) {
          for (int x = 0; x < kDofs; ++x) {
            const Num f = ji[r][x];
            Num* const line = block + kDofs * x;
            for (int y = 0; y < kDofs; ++y) line[y] += f * gj[r][y];
          }
        }
      }
    }
  }

  /// A = L D L^T, or L U. False if a pivot is not positive, or zero.
  bool Factor() noexcept { return symmetric_ ? FactorSymmetric() : FactorGeneral(); }

  /// x <- A^-1 x; 6 numbers a body.
  void Solve(Num* x) const noexcept {
    if (symmetric_) {
      SolveSymmetric(x);
    } else {
      SolveGeneral(x);
    }
  }

 private:
  Num* At(int i, int j) const noexcept {
    return a_ + kBlock * p_.slot[static_cast<int64_t>(i) * p_.count + j];
  }

  template <int R>
  static void Unpack(const Link<Num, R>& link, Num (*j)[kDofs]) noexcept {
    for (int r = 0; r < R; ++r) {
      j[r][0] = link.lin[r].x, j[r][1] = link.lin[r].y, j[r][2] = link.lin[r].z;
      j[r][3] = link.ang[r].x, j[r][4] = link.ang[r].y, j[r][5] = link.ang[r].z;
    }
  }

  /// a -= l u, all 6x6.
  static void Subtract(Num* a, const Num* l, const Num* u) noexcept {
    for (int x = 0; x < kDofs; ++x) {
      Num line[kDofs];
      for (int y = 0; y < kDofs; ++y) line[y] = a[kDofs * x + y];
      for (int m = 0; m < kDofs; ++m) {
        const Num f = l[kDofs * x + m];
        for (int y = 0; y < kDofs; ++y) line[y] -= f * u[kDofs * m + y];
      }
      for (int y = 0; y < kDofs; ++y) a[kDofs * x + y] = line[y];
    }
  }

  bool FactorSymmetric() noexcept {
    const Num one = Num::Splat(1.0), zero = Num::Splat(0.0);
    bool good = true;
    for (int k = 0; k < p_.count; ++k) {
      Num* const d = At(k, k);
      for (int p = 0; p < kDofs; ++p) {
        good = good && Any(d[7 * p] > zero);
        const Num inverse = one / d[7 * p];
        for (int i = p + 1; i < kDofs; ++i) {
          const Num f = d[6 * i + p] * inverse;
          for (int j = p + 1; j <= i; ++j) d[6 * i + j] -= f * d[6 * j + p];
        }
        for (int i = p + 1; i < kDofs; ++i) d[6 * i + p] *= inverse;
        d[7 * p] = inverse;
      }
      const int first = p_.first_below[k], last = p_.first_below[k + 1];
      // B L^-T = (L D)_ik; its transpose serves the updates, B becomes L_ik.
      for (int q = first; q < last; ++q) {
        Num* const b = At(p_.below[q], k);
        for (int r = 0; r < kDofs; ++r) {
          Num* const line = b + kDofs * r;
          for (int m = 0; m < kDofs; ++m) {
            const Num f = line[m];
            for (int c = m + 1; c < kDofs; ++c) line[c] -= f * d[6 * c + m];
          }
        }
      }
      for (int q = first; q < last; ++q) {
        const int j = p_.below[q];
        Num* const bj = At(j, k);
        Num transposed[kBlock];
        for (int r = 0; r < kDofs; ++r) {
          for (int c = 0; c < kDofs; ++c) transposed[kDofs * c + r] = bj[kDofs * r + c];
        }
        for (int r = 0; r < kDofs; ++r) {
          for (int c = 0; c < kDofs; ++c) bj[kDofs * r + c] *= d[7 * c];
        }
        // Column j of the update: rows from j on. Those further down still hold (L D).
        Subtract(At(j, j), bj, transposed);
        for (int s = q + 1; s < last; ++s) {
          const int i = p_.below[s];
          SubtractTransposed(At(i, j), At(i, k), bj);
        }
      }
    }
    return good;
  }

  /// a -= l u^T.
  static void SubtractTransposed(Num* a, const Num* l, const Num* u) noexcept {
    Num transposed[kBlock];
    for (int r = 0; r < kDofs; ++r) {
      for (int c = 0; c < kDofs; ++c) transposed[kDofs * c + r] = u[kDofs * r + c];
    }
    Subtract(a, l, transposed);
  }

  bool FactorGeneral() noexcept {
    const Num one = Num::Splat(1.0);
    bool good = true;
    for (int k = 0; k < p_.count; ++k) {
      Num* const d = At(k, k);
      for (int p = 0; p < kDofs; ++p) {
        good = good && Any(Abs(d[7 * p]) > Num::Splat(1e-300));
        const Num inverse = one / d[7 * p];
        d[7 * p] = inverse;
        for (int i = p + 1; i < kDofs; ++i) {
          const Num f = d[6 * i + p] * inverse;
          d[6 * i + p] = f;
          for (int j = p + 1; j < kDofs; ++j) d[6 * i + j] -= f * d[6 * p + j];
        }
      }
      const int first = p_.first_below[k], last = p_.first_below[k + 1];
      for (int q = first; q < last; ++q) {
        Num* const l = At(p_.below[q], k);  // <- l U^-1
        for (int r = 0; r < kDofs; ++r) {
          Num* const line = l + kDofs * r;
          for (int m = 0; m < kDofs; ++m) {
            line[m] *= d[7 * m];
            const Num f = line[m];
            for (int c = m + 1; c < kDofs; ++c) line[c] -= f * d[6 * m + c];
          }
        }
        Num* const u = At(k, p_.below[q]);  // <- L^-1 u
        for (int r = 1; r < kDofs; ++r) {
          for (int m = 0; m < r; ++m) {
            const Num f = d[6 * r + m];
            for (int c = 0; c < kDofs; ++c) u[kDofs * r + c] -= f * u[kDofs * m + c];
          }
        }
      }
      for (int q = first; q < last; ++q) {
        for (int s = first; s < last; ++s) {
          Subtract(At(p_.below[q], p_.below[s]), At(p_.below[q], k), At(k, p_.below[s]));
        }
      }
    }
    return good;
  }

  void Forward(Num* x) const noexcept {
    for (int k = 0; k < p_.count; ++k) {
      const Num* const d = At(k, k);
      Num* const b = x + kDofs * k;
      for (int i = 1; i < kDofs; ++i) {
        for (int m = 0; m < i; ++m) b[i] -= d[6 * i + m] * b[m];
      }
      for (int q = p_.first_below[k]; q < p_.first_below[k + 1]; ++q) {
        const Num* const l = At(p_.below[q], k);
        Num* const y = x + kDofs * p_.below[q];
        for (int r = 0; r < kDofs; ++r) {
          for (int m = 0; m < kDofs; ++m) y[r] -= l[kDofs * r + m] * b[m];
        }
      }
    }
  }

  void SolveSymmetric(Num* x) const noexcept {
    Forward(x);
    for (int k = p_.count - 1; k >= 0; --k) {
      const Num* const d = At(k, k);
      Num* const b = x + kDofs * k;
      for (int i = 0; i < kDofs; ++i) b[i] *= d[7 * i];
      for (int q = p_.first_below[k]; q < p_.first_below[k + 1]; ++q) {
        const Num* const l = At(p_.below[q], k);
        const Num* const y = x + kDofs * p_.below[q];
        for (int r = 0; r < kDofs; ++r) {
          for (int m = 0; m < kDofs; ++m) b[m] -= l[kDofs * r + m] * y[r];
        }
      }
      for (int i = kDofs - 1; i >= 0; --i) {
        for (int m = i + 1; m < kDofs; ++m) b[i] -= d[6 * m + i] * b[m];
      }
    }
  }

  void SolveGeneral(Num* x) const noexcept {
    Forward(x);
    for (int k = p_.count - 1; k >= 0; --k) {
      const Num* const d = At(k, k);
      Num* const b = x + kDofs * k;
      for (int q = p_.first_below[k]; q < p_.first_below[k + 1]; ++q) {
        const Num* const u = At(k, p_.below[q]);
        const Num* const y = x + kDofs * p_.below[q];
        for (int r = 0; r < kDofs; ++r) {
          for (int m = 0; m < kDofs; ++m) b[r] -= u[kDofs * r + m] * y[m];
        }
      }
      for (int i = kDofs - 1; i >= 0; --i) {
        for (int m = i + 1; m < kDofs; ++m) b[i] -= d[6 * i + m] * b[m];
        b[i] *= d[7 * i];
      }
    }
  }

  const BlockPattern& p_;
  Num* a_;
  bool symmetric_ = true;
};

}  // namespace taut::sim
