#include "base/bytes.h"
#include "identify/computed.h"

namespace taut::identify {
namespace {

void Put(base::ByteWriter& out, const std::vector<std::vector<double>>& lists) {
  out.Put(lists.size());
  for (const auto& list : lists) out.Put(list);
}

void Get(base::ByteReader& in, std::vector<std::vector<double>>& lists) {
  lists.resize(in.Size());
  for (auto& list : lists) in.Get(list);
}

}  // namespace

std::string Pack(const Computed& computed) {
  base::ByteWriter out;
  out.Put(computed.failed);
  out.Put(computed.unreadable);
  out.Put(computed.stopped);
  out.Put(computed.time_s);
  Put(out, computed.values);
  Put(out, computed.references);
  return std::move(out.bytes);
}

Computed UnpackComputed(const std::string& bytes) {
  base::ByteReader in(bytes);
  Computed computed;
  in.Get(computed.failed);
  in.Get(computed.unreadable);
  in.Get(computed.stopped);
  in.Get(computed.time_s);
  Get(in, computed.values);
  Get(in, computed.references);
  return computed;
}

}  // namespace taut::identify
