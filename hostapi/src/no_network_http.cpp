// In place of network_http.cpp where breve is built without the network.
#include "internal.hpp"

using namespace breve::host;

breve_status breve_network_open(const breve_network_config*, breve_network* network) {
  return guard([&] {
    need(network, "network");
    fail(BREVE_ERROR_UNSUPPORTED, "the network is not a part of this breve: it was built with BREVE_WITH_NETWORK=OFF");
  });
}

breve_status breve_network_release(breve_network* network) {
  if (!network) return BREVE_OK;
  if (network->release) network->release(network->user);
  *network = {};
  return BREVE_OK;
}
