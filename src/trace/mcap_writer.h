/// MCAP files: messages of many topics against time, with indexes for seeking
/// (https://mcap.dev/spec, version 0). Chunks are not compressed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "taut/files.h"
#include "taut/trace.h"

namespace taut::trace {

/// Threads: one at a time. The file gets its name when it is finished; until then, and forever if
/// it never is, an existing file of that name stays. After a function has returned false, `why()`
/// returns the reason.
class McapWriter {
 public:
  explicit McapWriter(std::string path) : file_(std::move(path)) {}

  /// `metadata`: pairs for readers, as one record called `taut`.
  bool Start(const std::string& library, const TraceMetadata& metadata);

  /// Adds a schema, which describes the content of messages, and a channel with that schema.
  /// Returns the channel's number, from 1 on. To be called before the first message.
  std::uint16_t AddChannel(const std::string& topic, const std::string& schema_name,
                           const std::string& json_schema);

  /// Times must not fall.
  bool Write(std::uint16_t channel, std::uint64_t time_ns, std::string_view json);
  bool Finish();

  const std::string& why() const { return file_.why(); }

 private:
  using Times = std::vector<std::pair<std::uint64_t, std::uint64_t>>;  ///< Times and offsets.
  struct Channel {
    std::string schema, record;  ///< The records as written in the file.
    std::uint32_t messages = 0;
    bool said = false;  ///< Whether both are in a chunk.
    Times index;        ///< Of the current chunk.
  };
  struct Chunk {
    std::uint64_t first_ns = 0, last_ns = 0, offset = 0, size = 0, records_size = 0;
    std::map<std::uint16_t, std::uint64_t> index_offsets;
    std::uint64_t index_size = 0;
  };

  bool Put(std::string_view bytes);
  bool CloseChunk();
  std::string Summary(std::uint64_t start) const;

  NewFile file_;
  std::uint64_t written_ = 0;
  std::uint32_t crc_ = 0;  ///< Of all that was written.
  std::vector<Channel> channels_;
  std::string chunk_;  ///< Records of the current chunk.
  std::uint64_t chunk_first_ns_ = 0, chunk_last_ns_ = 0;
  std::vector<Chunk> chunks_;
  std::uint64_t metadata_offset_ = 0, metadata_size_ = 0;
};

}  // namespace taut::trace
