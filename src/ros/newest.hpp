// Of several messages that wait, the newest counts.
#pragma once

#include <ros/callback_queue_interface.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <functional>
#include <memory>
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
  /// `queue`: the one whose callbacks call put(), from one thread. It may end before this does:
  /// roscpp keeps a subscriber's handler for a while after a nodelet and its queue are gone.
  Newest(ros::CallbackQueueInterface& queue, Handler handler)
      : queue_(queue), held_(std::make_shared<Held>()) {
    held_->handler = std::move(handler);
  }
  Newest(const Newest&) = delete;
  Newest& operator=(const Newest&) = delete;

  void put(Item item) {
    const bool due = held_->waiting.has_value();
    held_->waiting = std::move(item);
    if (!due) queue_.addCallback(boost::make_shared<Turn>(held_), id());
  }

 private:
  struct Held {
    Handler handler;
    std::optional<Item> waiting;
  };
  class Turn : public ros::CallbackInterface {
   public:
    explicit Turn(const std::shared_ptr<Held>& held) : held_(held) {}
    CallResult call() override {
      const std::shared_ptr<Held> held = held_.lock();  // none: who would handle it is gone
      if (held && held->waiting) {
        const Item item = std::move(*std::exchange(held->waiting, std::nullopt));
        held->handler(item);
      }
      return Success;
    }

   private:
    std::weak_ptr<Held> held_;
  };

  std::uint64_t id() const { return reinterpret_cast<std::uintptr_t>(this); }

  ros::CallbackQueueInterface& queue_;
  std::shared_ptr<Held> held_;
};

}  // namespace fpc
