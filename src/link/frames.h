/// Decoding of frames that boards send through the adapter.
#pragma once

#include <algorithm>
#include <bit>
#include <optional>
#include <span>

#include "taut/board/protocol.h"
#include "taut/link/names.h"

namespace taut::link {

/// Copies a complete frame of this board (status or reply). Returns false for other bytes.
inline bool CopyFrame(std::span<const std::uint8_t> bytes, std::uint8_t board,
                      std::uint8_t (&frame)[board::kFrameSize]) {
  if (bytes.size() != sizeof frame) return false;
  std::copy(bytes.begin(), bytes.end(), frame);
  return board::IsFrame(frame, sizeof frame, board);
}

inline std::optional<board::Status> StatusIn(std::span<const std::uint8_t> bytes,
                                             std::uint8_t board) {
  std::uint8_t frame[board::kFrameSize];
  if (!CopyFrame(bytes, board, frame) || board::IsReply(frame)) return std::nullopt;
  return board::DecodeStatus(frame);
}

inline std::optional<board::Reply> ReplyIn(std::span<const std::uint8_t> bytes,
                                           std::uint8_t board) {
  std::uint8_t frame[board::kFrameSize];
  if (!CopyFrame(bytes, board, frame) || !board::IsReply(frame)) return std::nullopt;
  return board::DecodeReply(frame);
}

inline board::Asking SetRequest(const Setting& setting) {
  return {board::Request::kSet, setting.place.parameter,
          static_cast<std::uint8_t>(setting.place.index),
          std::bit_cast<std::uint32_t>(setting.value), 0};
}

}  // namespace taut::link
