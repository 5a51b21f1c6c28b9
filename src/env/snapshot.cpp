#include "env/snapshot.h"

#include <cstring>
#include <string_view>

#include "base/hash.h"

namespace taut::env {
namespace {

struct Seal {
  std::uint64_t magic = 0x31766e6574756174;  ///< "tautenv1" in ASCII.
  std::uint64_t kind = 0, sum = 0;
};

std::uint64_t SumOf(std::span<const std::uint8_t> bytes) {
  base::Fnv1a sum;
  sum.Add({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  return sum.value();
}

}  // namespace

std::uint64_t KindOf(const Plan& plan) {
  base::Fnv1a kind;
  kind.AddText(ResolvedYaml(plan.experiment));
  kind.AddText(plan.options.randomise ? "randomised" : "as described");
  kind.AddText(std::to_string(static_cast<int>(plan.options.autoreset)));
  return kind.value();
}

std::vector<std::uint8_t> Sealed(std::uint64_t kind, const std::vector<std::uint8_t>& saved) {
  const Seal seal{.kind = kind, .sum = SumOf(saved)};
  std::vector<std::uint8_t> sealed(sizeof seal + saved.size());
  std::memcpy(sealed.data(), &seal, sizeof seal);
  std::memcpy(sealed.data() + sizeof seal, saved.data(), saved.size());
  return sealed;
}

std::optional<std::span<const std::uint8_t>> Unsealed(std::uint64_t kind,
                                                      std::span<const std::uint8_t> sealed,
                                                      Diagnostics& out) {
  Seal seal;
  const std::uint64_t magic = seal.magic;
  if (sealed.size() >= sizeof seal) std::memcpy(&seal, sealed.data(), sizeof seal);
  if (sealed.size() < sizeof seal || seal.magic != magic) {
    out.Error("snapshot.not_a_snapshot", {}, "the bytes are not a snapshot of an environment");
    return std::nullopt;
  }
  const auto saved = sealed.subspan(sizeof seal);
  if (seal.kind != kind) {
    out.Error("snapshot.other_environment", {}, "the snapshot is of another environment",
              "experiment, randomization and autoreset must be the same");
    return std::nullopt;
  }
  if (seal.sum != SumOf(saved)) {
    out.Error("snapshot.damaged", {}, "the snapshot is damaged: its checksum does not match");
    return std::nullopt;
  }
  return saved;
}

}  // namespace taut::env
