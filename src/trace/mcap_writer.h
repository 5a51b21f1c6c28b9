/// Writer of MCAP files: timestamped messages of many topics, with indexes for seeking
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

/// Use one thread at a time. Replaces an existing file only in `Finish`. If a function returns
/// false, `why()` returns the reason.
class McapWriter {
 public:
  explicit McapWriter(std::string path) : file_(std::move(path)) {}

  /// `metadata`: pairs of key and value, written as one record with the name `taut`.
  bool Start(const std::string& library, const TraceMetadata& metadata);

  /// Adds a JSON schema of messages and a channel with this schema. Returns the channel's number,
  /// starting at 1. Call this before the first message.
  std::uint16_t AddChannel(const std::string& topic, const std::string& schema_name,
                           const std::string& json_schema);

  /// Writes a message. Times must not decrease.
  bool Write(std::uint16_t channel, std::uint64_t time_ns, std::string_view json);
  bool Finish();

  const std::string& why() const { return file_.why(); }

 private:
  using Times = std::vector<std::pair<std::uint64_t, std::uint64_t>>;  ///< Pairs of time and
                                                                       ///< offset.
  struct Channel {
    std::string schema, record;  ///< Records as written in the file.
    std::uint32_t messages = 0;
    bool said = false;  ///< Whether both records were written.
    Times index;        ///< Index of the current chunk.
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
  std::uint32_t crc_ = 0;  ///< Checksum of all bytes written.
  std::vector<Channel> channels_;
  std::string chunk_;  ///< Records in the current chunk.
  std::uint64_t chunk_first_ns_ = 0, chunk_last_ns_ = 0;
  std::vector<Chunk> chunks_;
  std::uint64_t metadata_offset_ = 0, metadata_size_ = 0;
};

}  // namespace taut::trace
