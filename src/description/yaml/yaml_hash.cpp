#include "description/yaml/yaml_hash.h"

#include <fstream>
#include <iterator>

#include "base/hash.h"

namespace taut::description {

std::uint64_t HashInputs(const std::vector<std::string>& files, const Overrides& overrides) {
  base::Fnv1a hash;
  for (const std::string& path : files) {
    std::ifstream in(path, std::ios::binary);
    hash.AddText(std::string(std::istreambuf_iterator<char>(in), {}));
  }
  for (const auto& [name, expression] : overrides) {
    hash.AddText(name);
    hash.AddText(expression);
  }
  return hash.value();
}

}  // namespace taut::description
