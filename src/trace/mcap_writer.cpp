#include "trace/mcap_writer.h"

#include <zlib.h>

#include "base/assert.h"

namespace taut::trace {
namespace {

constexpr char kMagic[] = "\x89MCAP0\r\n";
constexpr std::size_t kMagicBytes = 8;
constexpr std::size_t kChunkBytes = std::size_t{1} << 20;  // size of a full chunk
constexpr char kMetadataName[] = "taut";

enum class Op : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

/// Builder of a record: little-endian numbers, and texts preceded by their lengths.
class Content {
 public:
  Content& U8(std::uint8_t x) { return Int(x, 1); }
  Content& U16(std::uint16_t x) { return Int(x, 2); }
  Content& U32(std::size_t x) { return Int(x, 4); }
  Content& U64(std::uint64_t x) { return Int(x, 8); }
  Content& Text(std::string_view text) { return U32(text.size()).Raw(text); }
  Content& Raw(std::string_view bytes) {
    bytes_ += bytes;
    return *this;
  }
  /// Appends a map: its size in bytes, then its pairs.
  template <class Map, class Each>
  Content& Pairs(const Map& map, const Each& each) {
    Content all;
    for (const auto& [key, value] : map) each(all, key, value);
    return Text(all.bytes_);
  }
  std::string Record(Op op) const {
    return Content().U8(static_cast<std::uint8_t>(op)).U64(bytes_.size()).Raw(bytes_).bytes_;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  Content& Int(std::uint64_t x, int size) {
    for (int i = 0; i < size; ++i) bytes_ += static_cast<char>(x >> (8 * i) & 0xff);
    return *this;
  }
  std::string bytes_;
};

std::uint32_t Crc(std::uint32_t before, std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

const auto kTexts = [](Content& to, const std::string& key, const std::string& value) {
  to.Text(key).Text(value);
};
const auto kCounts = [](Content& to, std::uint16_t key, std::uint64_t value) {
  to.U16(key).U64(value);
};
const auto kTimes = [](Content& to, std::uint64_t time_ns, std::uint64_t offset) {
  to.U64(time_ns).U64(offset);
};

}  // namespace

bool McapWriter::Put(std::string_view bytes) {
  crc_ = Crc(crc_, bytes);
  written_ += bytes.size();
  return file_.Write(bytes);
}

bool McapWriter::Start(const std::string& library, const TraceMetadata& metadata) {
  if (!file_.Create() || !Put({kMagic, kMagicBytes})) return false;
  if (!Put(Content().Text("").Text(library).Record(Op::kHeader))) return false;
  metadata_offset_ = written_;
  const std::string record =
      Content().Text(kMetadataName).Pairs(metadata, kTexts).Record(Op::kMetadata);
  metadata_size_ = record.size();
  return Put(record);
}

std::uint16_t McapWriter::AddChannel(const std::string& topic, const std::string& schema_name,
                                     const std::string& json_schema) {
  const auto number = static_cast<std::uint16_t>(channels_.size() + 1);
  Channel channel;
  channel.schema = Content()
                       .U16(number)
                       .Text(schema_name)
                       .Text("jsonschema")
                       .Text(json_schema)
                       .Record(Op::kSchema);
  channel.record =
      Content().U16(number).U16(number).Text(topic).Text("json").Text("").Record(Op::kChannel);
  channels_.push_back(std::move(channel));
  return number;
}

bool McapWriter::Write(std::uint16_t number, std::uint64_t time_ns, std::string_view json) {
  TAUT_ASSERT(number >= 1 && number <= channels_.size());
  Channel& channel = channels_[number - 1u];
  if (chunk_.empty()) chunk_first_ns_ = time_ns;
  chunk_last_ns_ = time_ns;
  if (!channel.said) {
    chunk_ += channel.schema + channel.record;
    channel.said = true;
  }
  channel.index.emplace_back(time_ns, chunk_.size());
  chunk_ += Content()
                .U16(number)
                .U32(channel.messages++)
                .U64(time_ns)
                .U64(time_ns)
                .Raw(json)
                .Record(Op::kMessage);
  return chunk_.size() < kChunkBytes || CloseChunk();
}

bool McapWriter::CloseChunk() {
  if (chunk_.empty()) return true;
  Chunk chunk;
  chunk.first_ns = chunk_first_ns_, chunk.last_ns = chunk_last_ns_;
  chunk.offset = written_, chunk.records_size = chunk_.size();
  const std::string record = Content()
                                 .U64(chunk.first_ns)
                                 .U64(chunk.last_ns)
                                 .U64(chunk_.size())
                                 .U32(Crc(0, chunk_))
                                 .Text("")
                                 .U64(chunk_.size())
                                 .Raw(chunk_)
                                 .Record(Op::kChunk);
  chunk.size = record.size();
  if (!Put(record)) return false;
  const std::uint64_t indexes = written_;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    Times& index = channels_[c].index;
    if (index.empty()) continue;
    const auto number = static_cast<std::uint16_t>(c + 1);
    chunk.index_offsets[number] = written_;
    if (!Put(Content().U16(number).Pairs(index, kTimes).Record(Op::kMessageIndex))) return false;
    index.clear();
  }
  chunk.index_size = written_ - indexes;
  chunks_.push_back(std::move(chunk));
  chunk_.clear();
  return true;
}

/// Returns all records of the summary section, followed by the offsets of their groups.
std::string McapWriter::Summary(std::uint64_t start) const {
  std::string all, offsets;
  const auto group = [&](Op op, const std::string& records) {
    if (records.empty()) return;
    offsets += Content()
                   .U8(static_cast<std::uint8_t>(op))
                   .U64(start + all.size())
                   .U64(records.size())
                   .Record(Op::kSummaryOffset);
    all += records;
  };
  std::string schemas, channels, indexes;
  std::uint64_t messages = 0;
  std::map<std::uint16_t, std::uint64_t> counts;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    schemas += channels_[c].schema, channels += channels_[c].record;
    counts[static_cast<std::uint16_t>(c + 1)] = channels_[c].messages;
    messages += channels_[c].messages;
  }
  for (const Chunk& chunk : chunks_) {
    indexes += Content()
                   .U64(chunk.first_ns)
                   .U64(chunk.last_ns)
                   .U64(chunk.offset)
                   .U64(chunk.size)
                   .Pairs(chunk.index_offsets, kCounts)
                   .U64(chunk.index_size)
                   .Text("")
                   .U64(chunk.records_size)
                   .U64(chunk.records_size)
                   .Record(Op::kChunkIndex);
  }
  const std::uint64_t first = chunks_.empty() ? 0 : chunks_.front().first_ns;
  const std::uint64_t last = chunks_.empty() ? 0 : chunks_.back().last_ns;
  group(Op::kSchema, schemas);
  group(Op::kChannel, channels);
  group(Op::kStatistics, Content()
                             .U64(messages)
                             .U16(static_cast<std::uint16_t>(channels_.size()))
                             .U32(channels_.size())
                             .U32(0)
                             .U32(1)
                             .U32(chunks_.size())
                             .U64(first)
                             .U64(last)
                             .Pairs(counts, kCounts)
                             .Record(Op::kStatistics));
  group(Op::kChunkIndex, indexes);
  group(Op::kMetadataIndex, Content()
                                .U64(metadata_offset_)
                                .U64(metadata_size_)
                                .Text(kMetadataName)
                                .Record(Op::kMetadataIndex));
  const std::uint64_t offsets_start = start + all.size();
  all += offsets;
  // The checksum of the summary section includes most of the footer.
  std::string footer = Content().U64(start).U64(offsets_start).U32(0).Record(Op::kFooter);
  footer.resize(footer.size() - 4);
  all += footer;
  return all + Content().U32(Crc(0, all)).bytes();
}

bool McapWriter::Finish() {
  if (!CloseChunk()) return false;
  if (!Put(Content().U32(crc_).Record(Op::kDataEnd))) return false;
  return Put(Summary(written_)) && Put({kMagic, kMagicBytes}) && file_.Sync() && file_.Publish();
}

}  // namespace taut::trace
