// Files of scripts. A machine opens none by itself: whoever embeds it does, or nobody.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "runtime/base/error.hpp"

namespace breve::steve {

class Machine;

/// A file that is open for reading.
class FileReader {
 public:
  virtual ~FileReader() = default;
  /// Up to `size` bytes; 0 at the end. Throws Error{File} if they cannot be read.
  virtual std::size_t read(char* bytes, std::size_t size) = 0;
  virtual const std::string& path() const = 0;  // as scripts see it; it opens the same file
};

/// A file that is open for writing. Its destructor closes it, and nobody hears if that fails.
class FileWriter {
 public:
  virtual ~FileWriter() = default;
  virtual void write(std::string_view bytes) = 0;  // throws Error{File} if they cannot all be written
  virtual void close() = 0;                        // throws Error{File} if not all that was written is kept
};

/// There is no file of that name, as far as the host lets scripts see.
class MissingFile : public Error {
 public:
  explicit MissingFile(const std::string& what) : Error(ErrorCode::File, what) {}
};

/// The largest file that is read as a whole.
constexpr std::size_t kMostFileBytes = std::size_t{256} << 20;

/// Open the file that a script names. Throws MissingFile; or Error{File} with the name and the reason if the host
/// refuses it, or gives scripts no files at all.
std::unique_ptr<FileReader> open_for_reading(Machine& machine, std::string_view name);
/// @param append  what is in the file stays; otherwise it is lost as soon as the file is closed
std::unique_ptr<FileWriter> open_for_writing(Machine& machine, std::string_view name, bool append);

/// All of it, in the world's memory. Throws Error{File} as above, or if it is larger than kMostFileBytes.
std::pmr::string read_file(Machine& machine, std::string_view name);
void write_file(Machine& machine, std::string_view name, std::string_view bytes);
/// The path of a file that can be opened for reading, as scripts see it; "" if it cannot.
std::string find_file(Machine& machine, std::string_view name);

}  // namespace breve::steve
