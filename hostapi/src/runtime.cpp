// Versions, statuses, runtimes: what a host gives and what lives as long as anybody uses it.
#include "internal.hpp"

namespace breve::host {

void* HostAllocator::do_allocate(std::size_t bytes, std::size_t alignment) {
  void* memory = config_.allocate(config_.user, bytes, alignment);
  if (!memory) throw std::bad_alloc();
  return memory;
}

void HostAllocator::do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) {
  config_.release(config_.user, memory, bytes, alignment);
}

}  // namespace breve::host

using namespace breve::host;

const char* breve_version(void) { return BREVE_VERSION; }

uint32_t breve_abi(void) { return BREVE_ABI; }

const char* breve_status_name(breve_status status) {
  switch (status) {
    case BREVE_OK: return "BREVE_OK";
    case BREVE_ERROR_ARGUMENT: return "BREVE_ERROR_ARGUMENT";
    case BREVE_ERROR_STALE: return "BREVE_ERROR_STALE";
    case BREVE_ERROR_BUSY: return "BREVE_ERROR_BUSY";
    case BREVE_ERROR_MEMORY: return "BREVE_ERROR_MEMORY";
    case BREVE_ERROR_SCRIPT: return "BREVE_ERROR_SCRIPT";
    case BREVE_ERROR_COMPILE: return "BREVE_ERROR_COMPILE";
    case BREVE_ERROR_BUDGET: return "BREVE_ERROR_BUDGET";
    case BREVE_ERROR_DEPTH: return "BREVE_ERROR_DEPTH";
    case BREVE_ERROR_IMAGE: return "BREVE_ERROR_IMAGE";
    case BREVE_ERROR_FILE: return "BREVE_ERROR_FILE";
    case BREVE_ERROR_UNSUPPORTED: return "BREVE_ERROR_UNSUPPORTED";
    case BREVE_ERROR_NOT_FOUND: return "BREVE_ERROR_NOT_FOUND";
    case BREVE_ERROR_TYPE: return "BREVE_ERROR_TYPE";
    case BREVE_ERROR_NO_BODY: return "BREVE_ERROR_NO_BODY";
    case BREVE_ERROR_INTERNAL: return "BREVE_ERROR_INTERNAL";
    case BREVE_ERROR_INTERRUPTED: return "BREVE_ERROR_INTERRUPTED";
    case BREVE_ERROR_RELOAD: return "BREVE_ERROR_RELOAD";
  }
  return "BREVE_ERROR_INTERNAL";
}

breve_status breve_runtime_create_for(uint32_t abi, const breve_runtime_config* config, breve_runtime** runtime) {
  return guard([&] {
    need(runtime, "runtime");
    if (abi != BREVE_ABI)
      fail(BREVE_ERROR_UNSUPPORTED, "the host was compiled for BREVE_ABI " + std::to_string(abi) +
                                        ", and this library has " + std::to_string(BREVE_ABI));
    const auto c = read_config(config, breve_runtime_config_default(), "breve_runtime_config");
    if ((c.allocate == nullptr) != (c.release == nullptr))
      fail(BREVE_ERROR_ARGUMENT, "allocate and release must both be given, or both be NULL");
    if (c.worker_threads != 0) fail(BREVE_ERROR_ARGUMENT, "a reserved field is not 0");
    constexpr std::uint32_t kRights = BREVE_RIGHT_SLEEP | BREVE_RIGHT_REAL_TIME | BREVE_RIGHT_ENTROPY;
    if ((c.rights & ~kRights) != 0)
      fail(BREVE_ERROR_ARGUMENT, "breve_runtime_config.rights is " + std::to_string(c.rights) +
                                     ", but the rights are " + std::to_string(kRights) + " in sum");
    auto handle = std::make_unique<breve_runtime>();
    handle->state = std::make_shared<RuntimeState>(c);
    *runtime = handle.release();
  });
}

breve_status breve_runtime_destroy(breve_runtime* runtime) {
  if (!runtime) return BREVE_OK;
  const breve_status status = guard(runtime->error, [&] {
    if (runtime->busy != 0) fail(BREVE_ERROR_BUSY, "the runtime is compiling or making a world");
  });
  if (status == BREVE_OK) delete runtime;
  return status;
}

const breve_error* breve_runtime_last_error(const breve_runtime* runtime) {
  return runtime ? runtime->error.view() : nullptr;
}
