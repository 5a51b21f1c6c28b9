/// MCAP files: messages of many topics against time, with what a reader needs to seek in them
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

/// Belongs to one thread at a time. The file takes its name when it is finished; what had the name
/// before stays until then, and for good if it never is. After a function has returned false,
/// `why()` is the reason.
class McapWriter {
 public:
  explicit McapWriter(std::string path) : file_(std::move(path)) {}

  /// `metadata`: pairs for readers, as one record called `taut`.
  bool Start(const std::string& library, const TraceMetadata& metadata);

  /// A kind of message, of which `schema` says what it holds, and messages of that kind. The
  /// channel's number, from 1 on. To be called before the first message.
  std::uint16_t AddChannel(const std::string& topic, const std::string& schema_name,
                           const std::string& json_schema);

  /// Times must not fall.
  bool Write(std::uint16_t channel, std::uint64_t time_ns, std::string_view json);
  bool Finish();

  const std::string& why() const { return file_.why(); }

 private:
  using Times = std::vector<std::pair<std::uint64_t, std::uint64_t>>;  ///< And offsets.
  struct Channel {
    std::string schema, record;  ///< The records as they stand in the file.
    std::uint32_t messages = 0;
    bool said = false;  ///< Whether both are in a chunk.
    Times index;        ///< Of the chunk that is filled.
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
  std::string chunk_;  ///< Records of the chunk that is filled.
  std::uint64_t chunk_first_ns_ = 0, chunk_last_ns_ = 0;
  std::vector<Chunk> chunks_;
  std::uint64_t metadata_offset_ = 0, metadata_size_ = 0;
};

}  // namespace taut::trace
