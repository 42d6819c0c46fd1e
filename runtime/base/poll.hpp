// How long work lets itself be ended.
#pragma once

#include <functional>

namespace breve {

/// Called again and again by long work, at least a hundred times a second; it may throw to end the work. Empty: nobody
/// wants to end it.
using Poll = std::function<void()>;

}  // namespace breve
