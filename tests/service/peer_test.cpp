#include "server/peer.h"

#include <gtest/gtest.h>

namespace holdfast::server {
namespace {

TEST(PeerNetwork, IsAnIpv4AddressWhateverItsPort) {
  EXPECT_EQ(peer_network("ipv4:10.1.2.3:5000"), "10.1.2.3");
  EXPECT_EQ(peer_network("ipv4:10.1.2.3:5001"), peer_network("ipv4:10.1.2.3:5000"));
  EXPECT_NE(peer_network("ipv4:10.1.2.4:5000"), peer_network("ipv4:10.1.2.3:5000"));
}

TEST(PeerNetwork, IsTheNetworkOfAnIpv6Address) {
  const std::string network = peer_network("ipv6:[2001:db8:1:2::3]:5000");
  EXPECT_EQ(network, "20010db800010002/64");
  EXPECT_EQ(peer_network("ipv6:[2001:db8:1:2:ffff::1]:77"), network);
  EXPECT_EQ(peer_network("ipv6:%5B2001:db8:1:2::4%5D:5000"), network);
  EXPECT_NE(peer_network("ipv6:[2001:db8:1:3::3]:5000"), network);
}

TEST(PeerNetwork, IsEmptyForWhatCannotBeToldApart) {
  for (const char* peer : {"", "unix:", "unix:/run/socket", "ipv4:", "ipv6:", "ipv6:[",
                           "ipv6::", "ipv6:[nonsense]:1", "ipv6:%5B:1", "ipv6:%5D%5B:1", "unknown"})
    EXPECT_EQ(peer_network(peer), "") << peer;
}

}  // namespace
}  // namespace holdfast::server
