#include "trace/mcap_reader.h"

#include <fmt/format.h>

#include <optional>

#include "base/input_file.h"

namespace taut::trace {
namespace {

constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
constexpr std::size_t kMostMcapBytes = std::size_t{1} << 30;

enum McapOp : std::uint8_t {
  kFooterOp = 0x02,
  kSchemaOp = 0x03,
  kChannelOp = 0x04,
  kMessageOp = 0x05,
  kChunkOp = 0x06,
  kMetadataOp = 0x0C,
  kDataEndOp = 0x0F,
};

/// Reader of the fields of a record; after the end of its bytes, `good` is false.
class Fields {
 public:
  explicit Fields(std::string_view bytes) : rest_(bytes) {}

  std::uint64_t Int(std::size_t size) {
    const std::string_view bytes = Raw(size);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      value |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
    }
    return value;
  }
  std::string_view Raw(std::uint64_t size) {
    if (size > rest_.size()) {
      good = false;
      rest_ = {};
      return {};
    }
    const std::string_view bytes = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return bytes;
  }
  std::string_view Text() { return Raw(Int(4)); }
  std::string_view rest() const { return rest_; }

  bool good = true;

 private:
  std::string_view rest_;
};

}  // namespace

bool McapReader::Damaged(const std::string& what) {
  out_.Error("mcap.damaged", {path_}, "the MCAP file is damaged: " + what);
  return false;
}

bool McapReader::Read(const std::function<bool(const McapMessage&)>& use) {
  const auto bytes = base::ReadInputFile(path_, kMostMcapBytes, "take a shorter part of the bag",
                                         out_, base::NamedBy::kUser);
  if (!bytes) return false;
  if (!bytes->starts_with(kMcapMagic)) {
    out_.Error("mcap.no_mcap", {path_}, "the file is not MCAP",
               "it does not begin with the bytes of the MCAP format");
    return false;
  }
  return Records(std::string_view(*bytes).substr(kMcapMagic.size()), use, false);
}

bool McapReader::Records(std::string_view bytes, const std::function<bool(const McapMessage&)>& use,
                         bool in_chunk) {
  Fields in(bytes);
  while (!in.rest().empty() && !stopped_ && !ended_) {
    const auto op = static_cast<std::uint8_t>(in.Int(1));
    const std::string_view content = in.Raw(in.Int(8));
    if (!in.good) {
      if (in_chunk) return Damaged("a record does not fit into its chunk");
      unfinished_ = true;
      return true;
    }
    Fields of(content);
    if (op == kSchemaOp) {
      const auto id = static_cast<std::uint16_t>(of.Int(2));
      McapSchema schema;
      for (std::string* const part : {&schema.name, &schema.encoding, &schema.text}) {
        *part = of.Text();
      }
      schemas_[id] = std::make_shared<const McapSchema>(std::move(schema));
    } else if (op == kChannelOp) {
      const auto id = static_cast<std::uint16_t>(of.Int(2));
      const auto schema = schemas_.find(static_cast<std::uint16_t>(of.Int(2)));
      McapChannel& channel = channels_[id];
      channel.topic = of.Text();
      channel.encoding = of.Text();
      if (schema != schemas_.end()) channel.schema = schema->second;
      if (channel.topic.size() > kMostMcapNameBytes) {
        return Damaged(
            fmt::format("the name of a topic has more than {} bytes", kMostMcapNameBytes));
      }
    } else if (op == kMessageOp) {
      McapMessage message;
      message.channel = static_cast<std::uint16_t>(of.Int(2));
      of.Int(4);  // skips the sequence number
      message.log_time_ns = of.Int(8);
      const std::uint64_t published_ns = of.Int(8);
      if (message.log_time_ns == 0) message.log_time_ns = published_ns;
      message.data = of.rest();
      if (!of.good || !channels_.contains(message.channel)) {
        return Damaged("a message belongs to no channel");
      }
      if (!use(message)) stopped_ = true;
    } else if (op == kChunkOp && !in_chunk) {
      if (!Chunk(content, use)) return false;
    } else if (op == kMetadataOp) {
      of.Text();  // skips the name
      Fields pairs(of.Text());
      while (pairs.good && !pairs.rest().empty()) {
        const std::string key(pairs.Text());
        metadata_.emplace_back(key, pairs.Text());
      }
    } else if (op == kFooterOp || op == kDataEndOp) {
      ended_ = true;
    }
    if (!of.good) return Damaged(fmt::format("a record of kind {} is too short", op));
  }
  if (!in_chunk && !ended_ && !stopped_) unfinished_ = true;
  return true;
}

bool McapReader::Chunk(std::string_view content,
                       const std::function<bool(const McapMessage&)>& use) {
  Fields of(content);
  of.Int(8), of.Int(8), of.Int(8), of.Int(4);  // skips times, size and checksum
  const std::string compression(of.Text());
  const std::string_view records = of.Raw(of.Int(8));
  if (!of.good) return Damaged("a chunk is too short");
  if (!compression.empty()) {
    out_.Error("mcap.compressed", {path_}, "the file is compressed with " + compression,
               "write it again with `mcap compress IN.mcap -o OUT.mcap --compression none`");
    return false;
  }
  return Records(records, use, true);
}

}  // namespace taut::trace
