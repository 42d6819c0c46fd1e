// Requests of peers, on their way to scripts.
#pragma once

namespace breve::steve {

class Machine;

/// Let each NetworkServer answer what waits for it. Between two iterations; nothing if the program has no such class.
void serve_requests(Machine& machine);

}  // namespace breve::steve
