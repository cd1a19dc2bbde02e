#include "ros/quick_negotiation.hpp"

#include <ros/xmlrpc_manager.h>
#include <sys/timerfd.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpcDispatch.h>
#include <xmlrpcpp/XmlRpcSource.h>

#include <boost/make_shared.hpp>
#include <cstdint>

#include "ros/wall_throttle.hpp"

namespace fpc {
namespace {

constexpr long kEvery_ns = 5000000;
constexpr double kFor_s = 5.0;

/// A clock among the sources of that thread, which ends its wait. All calls but the constructor
/// come from there.
class Alarm : public ros::ASyncXMLRPCConnection, private XmlRpc::XmlRpcSource {
 public:
  Alarm() : XmlRpcSource(timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {
    const itimerspec every{{0, kEvery_ns}, {0, kEvery_ns}};
    if (getfd() >= 0) timerfd_settime(getfd(), 0, &every, nullptr);
  }
  ~Alarm() override {
    if (getfd() >= 0) ::close(getfd());
  }
  void addToDispatch(XmlRpc::XmlRpcDispatch* dispatch) override {
    dispatch_ = dispatch;
    if (getfd() >= 0) dispatch->addSource(this, XmlRpc::XmlRpcDispatch::ReadableEvent);
  }
  void removeFromDispatch(XmlRpc::XmlRpcDispatch* dispatch) override {
    dispatch->removeSource(this);
  }
  /// True: it is over.
  bool check() override { return getfd() < 0 || steadyNow() - since_s_ > kFor_s; }

 private:
  unsigned handleEvent(unsigned) override {
    std::uint64_t times = 0;
    if (::read(getfd(), &times, sizeof times) > 0) dispatch_->exit();
    return XmlRpc::XmlRpcDispatch::ReadableEvent;
  }

  const double since_s_{steadyNow()};
  XmlRpc::XmlRpcDispatch* dispatch_{};
};

}  // namespace

void negotiateQuickly() {
  ros::XMLRPCManager::instance()->addASyncConnection(boost::make_shared<Alarm>());
}

}  // namespace fpc
