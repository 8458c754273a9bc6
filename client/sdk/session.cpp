#include <cmath>

#include <holdfast/client.h>

#include "client/sdk/exchange.h"
#include "client/sdk/session_keeper.h"
#include "proto/one_poller.h"

namespace holdfast::client {
namespace {

Exchange::Config exchange_config(const SessionOptions& options) {
  if (options.rewarm_frames < 0)
    throw InputError("rewarm_frames", "must be at least 0", std::to_string(options.rewarm_frames));
  if (!(options.frame_deadline_ms >= 0) || !std::isfinite(options.frame_deadline_ms))
    throw InputError("frame_deadline_ms", "must be finite and at least 0",
                     std::to_string(options.frame_deadline_ms));
  return {options.planes, options.width, options.height, options.rewarm_frames,
          options.frame_deadline_ms};
}

}  // namespace

class Session::Impl {
 public:
  explicit Impl(const SessionOptions& options)
      : exchange(exchange_config(options)), keeper(options, exchange) {}

  bool submit(std::shared_ptr<const Frame> frame, bool wait) {
    if (!exchange.submit(std::move(frame), wait)) return false;
    keeper.pump();
    return true;
  }

  void finish() {
    exchange.finish();
    keeper.pump();
  }

  void close() {
    finish();
    keeper.wait_closed();
    exchange.check_closed();
  }

  Exchange exchange;
  SessionKeeper keeper;
};

Session::Session(const SessionOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

void Session::submit(std::shared_ptr<const Frame> frame) { impl_->submit(std::move(frame), true); }
void Session::submit(Frame&& frame) { submit(std::make_shared<const Frame>(std::move(frame))); }
bool Session::try_submit(std::shared_ptr<const Frame> frame) {
  return impl_->submit(std::move(frame), false);
}
std::optional<FrameOutput> Session::receive() { return impl_->exchange.receive(true); }
std::optional<FrameOutput> Session::try_receive() { return impl_->exchange.receive(false); }
void Session::restart() { impl_->exchange.restart(); }
void Session::change(const SessionChange& change) { impl_->exchange.change(change); }
void Session::finish() { impl_->finish(); }
void Session::close() { impl_->close(); }
void Session::recycle(PlaneSet&& planes) { impl_->exchange.recycle(std::move(planes)); }
int Session::credits() const { return impl_->exchange.credits(); }
int Session::in_flight() const { return impl_->exchange.in_flight(); }
int Session::reconnects() const { return impl_->exchange.reconnects(); }
const std::vector<PlaneId>& Session::results() const { return impl_->keeper.results(); }
const std::string& Session::recipe() const { return impl_->keeper.session().recipe(); }
const std::string& Session::preset() const { return impl_->keeper.session().preset(); }
Traffic Session::traffic() const { return impl_->exchange.traffic(); }
bool Session::shared_memory() const { return impl_->keeper.shared_memory(); }

void prefer_one_poller() { wire::prefer_one_poller(); }

}  // namespace holdfast::client
