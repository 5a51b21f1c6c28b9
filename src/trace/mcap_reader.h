/// Records of MCAP files (https://mcap.dev/spec, version 0).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "taut/diagnostics.h"
#include "taut/trace.h"

namespace taut::trace {

/// Message of a channel. Views are valid during the call.
struct McapMessage {
  std::uint16_t channel = 0;
  std::uint64_t log_time_ns = 0;  ///< Log time, or publication time if the file has none.
  std::string_view data;
};

struct McapSchema {
  std::string name, encoding, text;
};

struct McapChannel {
  std::string topic, encoding;  ///< Encoding of the messages: "json", "cdr".
  std::shared_ptr<const McapSchema> schema =
      std::make_shared<McapSchema>();  ///< Shared: it may be large.
};

/// Longest topic or channel name [bytes]. Each number of a message has its own name.
inline constexpr std::size_t kMostMcapNameBytes = 1000;

/// Reads a file record by record. Compressed chunks are an error, whose message contains the
/// remedy.
/// From a truncated file, the reader returns the messages before the cut.
class McapReader {
 public:
  McapReader(std::string path, Diagnostics& out) : path_(std::move(path)), out_(out) {}

  /// Calls `use` for each message, in the order of the file, until it returns false. On an error,
  /// adds a diagnostic and returns false.
  bool Read(const std::function<bool(const McapMessage&)>& use);

  /// Channels so far; a channel is known before its first message.
  const std::map<std::uint16_t, McapChannel>& channels() const { return channels_; }
  const TraceMetadata& metadata() const { return metadata_; }
  /// Whether the file ends before its footer.
  bool unfinished() const { return unfinished_; }

 private:
  bool Records(std::string_view bytes, const std::function<bool(const McapMessage&)>& use,
               bool in_chunk);
  bool Chunk(std::string_view content, const std::function<bool(const McapMessage&)>& use);
  bool Damaged(const std::string& what);

  std::string path_;
  Diagnostics& out_;
  std::map<std::uint16_t, std::shared_ptr<const McapSchema>> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  TraceMetadata metadata_;
  bool unfinished_ = false, stopped_ = false, ended_ = false;
};

}  // namespace taut::trace
