/// A file that takes its name when it is worth it: until then what had the name stays.
#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace taut::base {

/// Belongs to one thread at a time. After a function has returned false, `why()` is the reason.
class NewFile {
 public:
  explicit NewFile(std::string path) : path_(std::move(path)) {}
  ~NewFile();  ///< What was not published is gone.
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Makes the file beside its place, under a name that nothing else has and no link leads to.
  bool Create();
  /// Where it is until it is published.
  const std::string& made_at() const { return made_at_; }

  bool Write(std::string_view bytes);
  /// Brings what was written to the disk and gives the file its name. Does nothing the second time.
  bool Publish();
  /// Brings what was written since to the disk.
  bool Sync();

  bool published() const { return published_; }
  const std::string& why() const { return why_; }

 private:
  bool Fail();

  std::string path_, made_at_, why_;
  int descriptor_ = -1;
  bool published_ = false;
};

}  // namespace taut::base
