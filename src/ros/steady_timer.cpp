#include "ros/steady_timer.hpp"

#include <pthread.h>
#include <ros/callback_queue_interface.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

namespace fpc {

using Instant = std::chrono::steady_clock::time_point;
using Deadlines = std::multimap<Instant, std::shared_ptr<TimerState>>;

/// Everything but `handler` belongs to the thread's mutex.
struct TimerState {
  std::function<void()> handler;
  std::chrono::nanoseconds period{};
  bool once{};
  ros::CallbackQueueInterface* queue{};
  std::uint64_t started{};  // how often: a callback of an earlier start is none
  bool runs{};
  Deadlines::iterator place;  // if `waits`
  bool waits{};
};

/// Puts what is due into the queues.
class TimerThread : public std::enable_shared_from_this<TimerThread> {
 public:
  static std::shared_ptr<TimerThread> ofProcess();
  TimerThread() : thread_([this] { run(); }) {
    pthread_setname_np(thread_.native_handle(), "steady_timers");
  }
  ~TimerThread();
  void start(const std::shared_ptr<TimerState>& state, std::chrono::nanoseconds in);
  bool runs(const TimerState& state);
  void stop(TimerState& state);
  /// The start that a callback belongs to is still the last one, and the timer has not been
  /// stopped.
  bool isDue(TimerState& state, std::uint64_t started);
  void next(const std::shared_ptr<TimerState>& state, Instant due, std::uint64_t started);

 private:
  void run();
  void fire(Deadlines::iterator first);
  void put(const std::shared_ptr<TimerState>& state, Instant due);
  void take(TimerState& state);

  std::mutex mutex_;
  std::condition_variable wake_;
  Deadlines deadlines_;
  bool ends_{false};
  std::thread thread_;
};

namespace {

class TimerTurn : public ros::CallbackInterface {
 public:
  TimerTurn(std::weak_ptr<TimerThread> thread, const std::shared_ptr<TimerState>& state,
            Instant due)
      : thread_(std::move(thread)), state_(state), due_(due), started_(state->started) {}
  CallResult call() override {
    const std::shared_ptr<TimerState> state = state_.lock();  // none: the timer is gone
    const std::shared_ptr<TimerThread> thread = thread_.lock();
    if (!state || !thread || !thread->isDue(*state, started_)) return Success;
    state->handler();
    thread->next(state, due_, started_);
    return Success;
  }

 private:
  std::weak_ptr<TimerThread> thread_;
  std::weak_ptr<TimerState> state_;
  Instant due_;
  std::uint64_t started_;
};

std::chrono::nanoseconds nanosecondsOf(double seconds) {
  constexpr double kLongest = 1e9;  // [s]
  return std::chrono::nanoseconds(
      static_cast<std::int64_t>(1e9 * std::clamp(seconds, 0.0, kLongest)));
}

}  // namespace

std::shared_ptr<TimerThread> TimerThread::ofProcess() {
  static std::mutex mutex;
  static std::weak_ptr<TimerThread> present;
  const std::lock_guard<std::mutex> lock(mutex);
  std::shared_ptr<TimerThread> thread = present.lock();
  if (!thread) present = thread = std::make_shared<TimerThread>();
  return thread;
}

TimerThread::~TimerThread() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void TimerThread::put(const std::shared_ptr<TimerState>& state, Instant due) {
  state->place = deadlines_.emplace(due, state);
  state->waits = true;
  if (state->place == deadlines_.begin()) wake_.notify_all();
}

void TimerThread::take(TimerState& state) {
  if (state.waits) deadlines_.erase(state.place);
  state.waits = false;
}

void TimerThread::start(const std::shared_ptr<TimerState>& state, std::chrono::nanoseconds in) {
  const std::lock_guard<std::mutex> lock(mutex_);
  take(*state);
  ++state->started;
  state->runs = true;
  put(state, std::chrono::steady_clock::now() + in);
}

bool TimerThread::runs(const TimerState& state) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return state.runs;
}

void TimerThread::stop(TimerState& state) {
  const std::lock_guard<std::mutex> lock(mutex_);
  take(state);
  state.runs = false;
}

bool TimerThread::isDue(TimerState& state, std::uint64_t started) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!state.runs || state.started != started) return false;
  if (state.once) state.runs = false;
  return true;
}

// What was missed is not made up for.
void TimerThread::next(const std::shared_ptr<TimerState>& state, Instant due,
                       std::uint64_t started) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!state->runs || state->started != started) return;
  put(state, std::max(due, std::chrono::steady_clock::now() - state->period) + state->period);
}

void TimerThread::fire(Deadlines::iterator first) {
  const std::shared_ptr<TimerState> state = first->second;
  const Instant due = first->first;
  take(*state);
  state->queue->addCallback(boost::make_shared<TimerTurn>(weak_from_this(), state, due));
}

void TimerThread::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ends_) {
    if (deadlines_.empty()) {
      wake_.wait(lock);
    } else if (deadlines_.begin()->first <= std::chrono::steady_clock::now()) {
      fire(deadlines_.begin());
    } else {
      const Instant due = deadlines_.begin()->first;
      wake_.wait_until(lock, due);
    }
  }
}

SteadyTimer::SteadyTimer(const ros::NodeHandle& node, double period_s,
                         std::function<void()> handler, Kind kind)
    : thread_(TimerThread::ofProcess()), state_(std::make_shared<TimerState>()) {
  state_->handler = std::move(handler);
  state_->period = nanosecondsOf(period_s);
  state_->once = kind == Kind::kOnce;
  state_->queue = node.getCallbackQueue();
}

SteadyTimer& SteadyTimer::operator=(SteadyTimer&& other) {
  stop();
  state_ = std::move(other.state_);
  thread_ = std::move(other.thread_);
  return *this;
}

void SteadyTimer::start() {
  if (state_ && !thread_->runs(*state_)) thread_->start(state_, state_->period);
}

void SteadyTimer::startIn(double seconds) {
  if (state_) thread_->start(state_, nanosecondsOf(seconds));
}

void SteadyTimer::stop() {
  if (state_) thread_->stop(*state_);
}

}  // namespace fpc
