/// Messages of ROS 2: definitions (ros2msg) and their binary form (CDR).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace taut::trace {

/// Decodes all numbers of messages of one type.
class Ros2Message {
 public:
  /// Parses a definition with the definitions of the types it uses, as rosbag2 stores it. Returns
  /// nothing, with the reason in `why`, for types without a definition.
  static std::optional<Ros2Message> Parse(const std::string& name, const std::string& definition,
                                          std::string& why);

  /// Calls `number` with the path and the value of each number, such as "effort/knee". Elements of
  /// a list are named by the texts in the neighboring list `name`, by their field `child_frame_id`,
  /// or by their index. Bytes and lists of more than 64 elements are omitted. Returns false for
  /// data that end early or have another encoding.
  bool Decode(std::string_view cdr,
              const std::function<void(const std::string& path, double value)>& number) const;

 private:
  struct Field {
    std::string type, name;
    bool is_list = false;
    std::uint32_t fixed = 0;  ///< Number of elements of a list; 0: any.
  };
  using Type = std::vector<Field>;

  class Decoder;

  std::map<std::string, Type> types_;
  std::string name_;
};

}  // namespace taut::trace
