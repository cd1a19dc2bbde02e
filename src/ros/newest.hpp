// Of several messages that wait, the newest counts.
#pragma once

#include <ros/callback_queue_interface.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

namespace fpc {

/// Passes an item on once everything that waited in the queue when it came has been looked at; one
/// that comes meanwhile takes its place. So who put strange items aside before put() is not
/// misled by them, as the end of a short queue would be.
template <typename Item>
class Newest {
 public:
  using Handler = std::function<void(const Item&)>;
  /// `queue`: the one whose callbacks call put(), from one thread; it must outlive this.
  Newest(ros::CallbackQueueInterface& queue, Handler handler)
      : queue_(queue), handler_(std::move(handler)) {}
  ~Newest() { queue_.removeByID(id()); }
  Newest(const Newest&) = delete;
  Newest& operator=(const Newest&) = delete;

  void put(Item item) {
    const bool due = waiting_.has_value();
    waiting_ = std::move(item);
    if (!due) queue_.addCallback(boost::make_shared<Turn>(*this), id());
  }

 private:
  class Turn : public ros::CallbackInterface {
   public:
    explicit Turn(Newest& newest) : newest_(newest) {}
    CallResult call() override {
      newest_.pass();
      return Success;
    }

   private:
    Newest& newest_;
  };

  std::uint64_t id() const { return reinterpret_cast<std::uintptr_t>(this); }
  void pass() {
    if (!waiting_) return;
    const Item item = std::move(*std::exchange(waiting_, std::nullopt));
    handler_(item);
  }

  ros::CallbackQueueInterface& queue_;
  Handler handler_;
  std::optional<Item> waiting_;
};

}  // namespace fpc
