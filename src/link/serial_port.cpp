#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/serial_port.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <optional>
#include <utility>

#include "link/device_lock.h"
#include "taut/link/port.h"

namespace taut::link {
namespace {

namespace asio = boost::asio;
using Clock = std::chrono::steady_clock;

class SerialPort final : public Port {
 public:
  SerialPort(std::string device, PortUse use) : device_(std::move(device)), use_(use) {}

  /// Opens the device. Returns an empty text on success, otherwise an error message.
  std::string Open() {
    boost::system::error_code error;
    port_.emplace(context_);
    port_->open(device_, error);  // Asio sets raw mode
    if (!error && use_ == PortUse::kDrive) {
      // An adapter that was unplugged and plugged in again is a new device, so lock it at every
      // opening.
      const int handle = port_->native_handle();
      if (flock(handle, LOCK_EX | LOCK_NB) != 0) {
        port_.reset();
        return kDriven;
      }
      ioctl(handle, TIOCEXCL);  // also excludes programs that do not use flock, except root's
                                // programs
    }
    // The adapter ignores the baud rate, but some drivers require one.
    if (!error) port_->set_option(asio::serial_port_base::baud_rate(115'200), error);
    if (!error) port_->set_option(asio::serial_port_base::flow_control(), error);
    if (error) {
      port_.reset();
      return error == boost::system::errc::device_or_resource_busy ? kDriven : error.message();
    }
    arrived_.clear();
    context_.restart();
    Listen();
    return {};
  }

  bool Write(std::span<const std::uint8_t> frame) override {
    if (!port_) return false;
    boost::system::error_code error;
    asio::write(*port_, asio::buffer(frame.data(), frame.size()), error);
    if (error) Close();
    return !error;
  }

  Bytes Read() override {
    context_.restart();
    context_.poll();
    return std::exchange(arrived_, {});
  }

  void Wait(double until_s) override {
    const auto until = Clock::time_point(
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(until_s)));
    // Without a port, Asio would return from the wait at once.
    std::optional<asio::executor_work_guard<asio::io_context::executor_type>> guard;
    guard.emplace(context_.get_executor());
    context_.restart();
    while (arrived_.empty() && context_.run_one_until(until) > 0) {
    }
  }

  double now_s() const override {
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  }
  bool is_open() const override { return port_.has_value(); }
  bool Reopen() override { return Open().empty(); }

  static constexpr char kDriven[] = "another program drives it";

 private:
  void Listen() {
    port_->async_read_some(asio::buffer(chunk_),
                           [this](const boost::system::error_code& error, std::size_t size) {
                             if (error == asio::error::operation_aborted) return;
                             if (error) return Close();
                             arrived_.insert(arrived_.end(), chunk_.begin(),
                                             chunk_.begin() + static_cast<std::ptrdiff_t>(size));
                             Listen();
                           });
  }

  void Close() { port_.reset(); }

  std::string device_;
  PortUse use_;
  asio::io_context context_;
  std::optional<asio::serial_port> port_;  ///< Empty if the connection is lost.
  std::array<std::uint8_t, 256> chunk_{};
  Bytes arrived_;
};

}  // namespace

std::unique_ptr<Port> OpenSerialPort(const std::string& device, PortUse use, Diagnostics& out) {
  auto port = std::make_unique<SerialPort>(device, use);
  const std::string why = port->Open();
  if (why.empty()) return port;
  if (why == SerialPort::kDriven) {
    const auto process = DriverOf(device);
    out.Error("robot.driven_elsewhere", {device, 0, 0},
              (process ? "process " + std::to_string(*process) : std::string("another program")) +
                  " drives this robot",
              "to stop the robot, run `taut robot estop`");
    return nullptr;
  }
  out.Error("robot.not_opened", {device, 0, 0}, "cannot open: " + why,
            "the adapter is usually /dev/ttyACM0, for users in the group dialout; --port virtual "
            "selects the emulated robot");
  return nullptr;
}

}  // namespace taut::link
