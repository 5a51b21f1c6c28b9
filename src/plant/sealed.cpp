#include "plant/sealed.h"

#include <cstring>
#include <string>

#include "base/hash.h"

namespace taut::plant {
namespace {

struct Head {
  std::uint64_t magic = 0x3170616e73747561;  ///< "autsnap1" in ASCII.
  std::uint64_t kind = 0, sum = 0;
};

std::uint64_t SumOf(std::span<const std::uint8_t> bytes) {
  base::Fnv1a sum;
  sum.Add({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  return sum.value();
}

}  // namespace

std::vector<std::uint8_t> Sealing::Seal(const std::vector<std::uint8_t>& saved) const {
  const Head head{.kind = kind_, .sum = SumOf(saved)};
  std::vector<std::uint8_t> sealed(sizeof head + saved.size());
  std::memcpy(sealed.data(), &head, sizeof head);
  std::memcpy(sealed.data() + sizeof head, saved.data(), saved.size());
  return sealed;
}

std::optional<std::span<const std::uint8_t>> Sealing::Open(std::span<const std::uint8_t> sealed,
                                                           Diagnostics& out) const {
  const std::string name(class_name_);
  Head head;
  const std::uint64_t magic = head.magic;
  if (sealed.size() >= sizeof head) std::memcpy(&head, sealed.data(), sizeof head);
  if (sealed.size() < sizeof head || head.magic != magic) {
    out.Error("snapshot.not_a_snapshot", {},
              "the bytes are not a snapshot of this version of taut");
    return std::nullopt;
  }
  const auto saved = sealed.subspan(sizeof head);
  if (head.kind != kind_) {
    out.Error("snapshot.other_environment", {}, "the snapshot belongs to another " + name,
              std::string(differences_));
    return std::nullopt;
  }
  if (head.sum != SumOf(saved)) {
    out.Error("snapshot.damaged", {}, "the snapshot is damaged: its checksum does not match");
    return std::nullopt;
  }
  return saved;
}

}  // namespace taut::plant
