// What roscpp and xmlrpcpp read from the network, checked before they use it. These definitions
// take the place of the libraries' own: the dynamic linker finds those of the program first, and
// those of a library that is preloaded (nodelet managers). Each repeats what it replaces and adds
// one check.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <ros/connection.h>
#include <ros/header.h>
#include <ros/network.h>
#include <ros/publisher.h>
#include <ros/topic_manager.h>
#include <ros/transport/transport_tcp.h>
#include <ros/transport/transport_udp.h>
#include <sys/socket.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpc.h>
#include <xmlrpcpp/XmlRpcException.h>
#include <xmlrpcpp/XmlRpcServerConnection.h>
#include <xmlrpcpp/XmlRpcSocket.h>

#include <boost/make_shared.hpp>
#include <cerrno>
#include <cstring>

namespace {

constexpr std::uint32_t kLongestHeader = 1u << 20;  // [bytes] of TCPROS
constexpr std::size_t kLongestHttpHeader = 1u << 16;
constexpr std::size_t kLongestMessage = 1u << 26;  // of XMLRPC: a loop's text is one
constexpr int kDeepest = 32;                       // values in values

std::uint32_t numberAt(const std::uint8_t* bytes) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

constexpr unsigned kDead_ms = 8000, kDeadRequest_ms = 4000;  // without an answer of the other end

template <typename Value>
void setOption(int socket, int level, int option, Value value) {
  ::setsockopt(socket, level, option, &value, sizeof value);
}

/// Both ends are on this machine, where a link cannot be cut, but a process may hang for long.
bool isLocal(int socket) {
  sockaddr_in here{}, there{};
  socklen_t size = sizeof here;
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&here), &size) != 0) return false;
  size = sizeof there;
  return ::getpeername(socket, reinterpret_cast<sockaddr*>(&there), &size) == 0 &&
         here.sin_family == AF_INET && here.sin_addr.s_addr == there.sin_addr.s_addr;
}

bool isLoopback(const std::string& host) {
  return host == "localhost" || host == "::1" || host.rfind("127.", 0) == 0;
}

}  // namespace

namespace ros {

bool Header::parse(const boost::shared_array<std::uint8_t>& buffer, std::uint32_t size,
                   std::string& error_msg) {
  return parse(buffer.get(), size, error_msg);
}

// The library's own trusts the length of an element.
bool Header::parse(std::uint8_t* buffer, std::uint32_t size, std::string& error_msg) {
  for (std::uint32_t at = 0; at < size;) {
    const std::uint32_t length = size - at < 4 ? size : numberAt(buffer + at);
    if (length > size - at || length + 4 > size - at) {
      error_msg = "Received an invalid TCPROS header: an element is longer than the header.";
      return false;
    }
    const std::string element(reinterpret_cast<const char*>(buffer) + at + 4, length);
    const std::size_t equals = element.find('=');
    if (equals == std::string::npos) {
      error_msg = "Received an invalid TCPROS header: an element has no equals sign.";
      return false;
    }
    (*read_map_)[element.substr(0, equals)] = element.substr(equals + 1);
    at += 4 + length;
  }
  return true;
}

// The library's own reserves up to a gigabyte before a byte of it has come.
void Connection::onHeaderLengthRead(const ConnectionPtr& conn,
                                    const boost::shared_array<std::uint8_t>& buffer, std::uint32_t,
                                    bool success) {
  if (!success) return;
  const std::uint32_t length = numberAt(buffer.get());
  if (length > kLongestHeader) {
    conn->drop(HeaderError);
    return;
  }
  read(length, [this](const ConnectionPtr& from, const boost::shared_array<std::uint8_t>& bytes,
                      std::uint32_t size, bool whole) { onHeaderRead(from, bytes, size, whole); });
}

// A subscriber that asks for datagrams of 8 bytes makes the library's own divide by 0. Nobody here
// asks for datagrams.
TransportUDPPtr TransportUDP::createOutgoing(std::string, int, int, int) { return {}; }

// The library's own keeps what is latched after it has handed it over: who connects in between got
// neither. Kept before, such a one may get it twice.
void Publisher::publish(const boost::function<SerializedMessage()>& serialized,
                        SerializedMessage& message) const {
  if (!impl_ || !impl_->isValid()) return;
  if (!impl_->latch_) return TopicManager::instance()->publish(impl_->topic_, serialized, message);
  const SerializedMessage kept = serialized();
  {
    const boost::mutex::scoped_lock lock(impl_->last_message_mutex_);
    impl_->last_message_ = kept;
  }
  TopicManager::instance()->publish(
      impl_->topic_, [&kept] { return kept; }, message);
}

// The library's own lets a connection whose link was cut wait for its next attempt, for as long
// again as the link was cut; ended, it is made anew (Links).
void TransportTCP::setKeepAlive(bool use, std::uint32_t, std::uint32_t, std::uint32_t) {
  setOption(sock_, SOL_SOCKET, SO_KEEPALIVE, use ? 1 : 0);
  if (!use || is_server_ || isLocal(sock_)) return;
  setOption(sock_, IPPROTO_TCP, TCP_KEEPIDLE, 3);
  setOption(sock_, IPPROTO_TCP, TCP_KEEPINTVL, 1);
  setOption(sock_, IPPROTO_TCP, TCP_USER_TIMEOUT, kDead_ms);
}

}  // namespace ros

namespace XmlRpc {

// The library's own waits for two minutes for a machine that does not answer.
int XmlRpcSocket::socket() {
  const int made = ::socket(s_use_ipv6_ ? AF_INET6 : AF_INET, SOCK_STREAM, 0);
  if (made >= 0) setOption(made, IPPROTO_TCP, TCP_USER_TIMEOUT, kDeadRequest_ms);
  return made;
}

// The library's own listens on all addresses, whatever ROS_HOSTNAME says.
bool XmlRpcSocket::bind(int socket, int port) {
  const bool here_only = isLoopback(ros::network::getHost());
  const auto network_port = htons(static_cast<std::uint16_t>(port));
  if (s_use_ipv6_) {
    sockaddr_in6 address{};
    address.sin6_family = AF_INET6;
    address.sin6_addr = here_only ? in6addr_loopback : in6addr_any;
    address.sin6_port = network_port;
    return ::bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(here_only ? INADDR_LOOPBACK : INADDR_ANY);
  address.sin_port = network_port;
  return ::bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
}

// The library's own reads for as long as somebody sends.
bool XmlRpcSocket::nbRead(int socket, std::string& text, bool* eof) {
  char buffer[4096];
  *eof = false;
  while (text.size() <= kLongestMessage) {
    const ssize_t count = ::read(socket, buffer, sizeof buffer);
    if (count > 0) {
      text.append(buffer, static_cast<std::size_t>(count));
    } else if (count == 0) {
      *eof = true;
      return true;
    } else {
      return errno == EINPROGRESS || errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    }
  }
  return false;
}

// The library's own looks through a header without an end again and again.
unsigned XmlRpcServerConnection::handleEvent(unsigned) {
  if (_connectionState == READ_HEADER && (!readHeader() || _header.size() > kLongestHttpHeader))
    return 0;
  if (_connectionState == READ_REQUEST && !readRequest()) return 0;
  if (_connectionState == WRITE_RESPONSE && !writeResponse()) return 0;
  return _connectionState == WRITE_RESPONSE ? XmlRpcDispatch::WritableEvent
                                            : XmlRpcDispatch::ReadableEvent;
}

// The library's own lets other exceptions end the process, and runs into itself in
// system.multicall, which no node of ROS uses.
void XmlRpcServerConnection::executeRequest() {
  try {
    XmlRpcValue params, result;
    const std::string method = parseRequest(params);
    if (executeMethod(method, params, result))
      generateResponse(result.toXml());
    else
      generateFaultResponse(method + ": unknown method name");
  } catch (const XmlRpcException& fault) {
    generateFaultResponse(fault.getMessage(), fault.getCode());
  } catch (const std::exception& error) {
    generateFaultResponse(error.what());
  }
}

// The library's own calls itself for every value in a value until the stack ends.
bool XmlRpcValue::fromXml(const std::string& xml, int* offset) {
  thread_local int depth = 0;
  if (offset == nullptr || depth >= kDeepest) return false;
  const struct Level {
    Level() { ++depth; }
    ~Level() { --depth; }
  } level;
  const int before = *offset;
  invalidate();
  if (!XmlRpcUtil::nextTagIs("<value>", xml, offset)) return false;
  const int inside = *offset;
  const std::string tag = XmlRpcUtil::getNextTag(xml, offset);
  bool done = false;
  if (tag == "<boolean>") {
    done = boolFromXml(xml, offset);
  } else if (tag == "<i4>" || tag == "<int>") {
    done = intFromXml(xml, offset);
  } else if (tag == "<double>") {
    done = doubleFromXml(xml, offset);
  } else if (tag.empty() || tag == "<string>") {
    done = stringFromXml(xml, offset);
  } else if (tag == "<dateTime.iso8601>") {
    done = timeFromXml(xml, offset);
  } else if (tag == "<base64>") {
    done = binaryFromXml(xml, offset);
  } else if (tag == "<array>") {
    done = arrayFromXml(xml, offset);
  } else if (tag == "<struct>") {
    done = structFromXml(xml, offset);
  } else if (tag == "</value>") {  // an empty text
    *offset = inside;
    done = stringFromXml(xml, offset);
  }
  if (done)
    XmlRpcUtil::findTag("</value>", xml, offset);
  else
    *offset = before;
  return done;
}

}  // namespace XmlRpc
