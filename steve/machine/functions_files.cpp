// Files as scripts see them: lines and whole texts through a pointer.
#include <array>
#include <memory>
#include <string>

#include "steve/machine/files.hpp"
#include "steve/machine/functions.hpp"
#include "steve/machine/machine.hpp"

namespace breve::steve {

namespace {

/// A file that is open for reading or for writing, or closed. Closed, it holds nothing that takes room.
class FilePointer final : public NativePointer {
 public:
  explicit FilePointer(std::unique_ptr<FileReader> reader)
      : reader_(std::move(reader)), block_(std::make_unique<Block>()) {}
  explicit FilePointer(std::unique_ptr<FileWriter> writer) : writer_(std::move(writer)) {}

  FileReader& reader() const {
    if (!reader_) Machine::fail(RunErrorKind::Type, writer_ ? "this file was opened for writing" : kClosed);
    return *reader_;
  }
  FileWriter& writer() const {
    if (!writer_) Machine::fail(RunErrorKind::Type, reader_ ? "this file was opened for reading" : kClosed);
    return *writer_;
  }
  void close() {
    reader_.reset();
    block_.reset();
    at_ = size_ = 0;
    if (const auto writer = std::move(writer_)) writer->close();
  }

  /// The bytes read and not taken. Reads more if all were taken; empty at the end of the file. Reading counts as work.
  std::string_view ahead(Machine& machine) {
    if (at_ == size_) {
      FileReader& file = reader();
      at_ = size_ = 0;
      size_ = file.read(block_->data(), block_->size());
      end_ = size_ == 0;
      machine.charge_for(size_);
    }
    return {block_->data() + at_, size_ - at_};
  }
  void take(std::size_t bytes) { at_ += bytes; }
  bool end() const { return end_; }

 private:
  static constexpr const char* kClosed = "this file is closed";
  using Block = std::array<char, 4096>;

  std::unique_ptr<FileReader> reader_;
  std::unique_ptr<FileWriter> writer_;
  std::unique_ptr<Block> block_;
  std::size_t at_ = 0, size_ = 0;
  bool end_ = false;
};

FilePointer& file_of(PointerCell* pointer) {
  if (pointer == nullptr)
    throw RunError(RunErrorKind::Type, "this file was not opened: the pointer is null",
                   "opening returns null if the file does not exist or may not be read: test the pointer with 'if'");
  auto* file = dynamic_cast<FilePointer*>(pointer->native.get());
  if (file == nullptr) Machine::fail(RunErrorKind::Type, "this pointer is not an open file");
  return *file;
}

/// NULL if it cannot be opened: with a warning unless there is no such file, which the program is to find out.
template <class Open>
PointerCell* open_file(Machine& machine, std::string_view name, Open open) {
  machine.charge_for(name.size());
  try {
    return machine.heap().pointer(std::make_unique<FilePointer>(open()));
  } catch (const MissingFile&) {
    return nullptr;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::File) throw;
    machine.warn_once("file:" + std::string(name), error.what());
    return nullptr;
  }
}

PointerCell* open_to_read(Machine& machine, Instance&, StringCell* name) {
  return open_file(machine, view(name), [&] { return open_for_reading(machine, view(name)); });
}
PointerCell* open_to_write(Machine& machine, Instance&, StringCell* name) {
  return open_file(machine, view(name), [&] { return open_for_writing(machine, view(name), false); });
}
PointerCell* open_to_append(Machine& machine, Instance&, StringCell* name) {
  return open_file(machine, view(name), [&] { return open_for_writing(machine, view(name), true); });
}

void append(std::pmr::string& text, std::string_view part) {
  if (part.size() >= kMostFileBytes - text.size())
    Machine::fail(RunErrorKind::Bounds, "the text that is read from this file is longer than 256 MiB");
  text.append(part);
}

/// One line without its end, which may be "\n" or "\r\n".
std::pmr::string line_of(Machine& machine, FilePointer& file) {
  std::pmr::string line(machine.heap().memory());
  for (std::string_view ahead = file.ahead(machine); !ahead.empty(); ahead = file.ahead(machine)) {
    const std::size_t end = ahead.find('\n');
    append(line, ahead.substr(0, end));
    file.take(end == std::string_view::npos ? ahead.size() : end + 1);
    if (end != std::string_view::npos) break;
  }
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return line;
}

StringCell* read_line(Machine& machine, Instance&, PointerCell* pointer) {
  return machine.heap().string(line_of(machine, file_of(pointer)));
}

StringCell* read_whole(Machine& machine, Instance&, PointerCell* pointer) {
  FilePointer& file = file_of(pointer);
  std::pmr::string text(machine.heap().memory());
  for (std::string_view ahead = file.ahead(machine); !ahead.empty(); ahead = file.ahead(machine)) {
    append(text, ahead);
    file.take(ahead.size());
  }
  return machine.heap().string(text);
}

void push_text(Heap& heap, ListCell& list, std::string_view text) {
  heap.push(list, Value::of(Tag::String, heap.string(text)));
}

/// Split at every delimiter, which may be several bytes long; none: the line is the only element. "" gives {}.
ListCell* read_delimited(Machine& machine, Instance&, PointerCell* pointer, StringCell* delimiter) {
  const std::pmr::string line = line_of(machine, file_of(pointer));
  const std::string_view cut = view(delimiter);
  ListCell* list = machine.heap().list();
  if (line.empty()) return list;
  std::size_t start = 0;
  for (auto at = cut.empty() ? std::string::npos : line.find(cut); at != std::string::npos;
       at = line.find(cut, start)) {
    push_text(machine.heap(), *list, std::string_view(line).substr(start, at - start));
    start = at + cut.size();
  }
  push_text(machine.heap(), *list, std::string_view(line).substr(start));
  return list;
}

ListCell* read_words(Machine& machine, Instance&, PointerCell* pointer) {
  constexpr std::string_view kBlanks = " \t\r\v\f";
  const std::pmr::string line = line_of(machine, file_of(pointer));
  ListCell* list = machine.heap().list();
  for (auto start = line.find_first_not_of(kBlanks); start != std::string::npos;) {
    const auto end = line.find_first_of(kBlanks, start);
    push_text(machine.heap(), *list, std::string_view(line).substr(start, end - start));
    start = end == std::string::npos ? end : line.find_first_not_of(kBlanks, end);
  }
  return list;
}

void write_string(Machine& machine, Instance&, PointerCell* pointer, StringCell* text) {
  constexpr std::uint64_t kOfWriting = 48;  // iterations
  FileWriter& file = file_of(pointer).writer();
  machine.charge(kOfWriting);
  try {
    file.write(view(text));
  } catch (const Error& error) {
    machine.warn(std::string("writeString: the text could not be written completely: ") + error.what());
  }
}

std::int32_t at_end(Machine&, Instance&, PointerCell* pointer) { return file_of(pointer).end() ? 1 : 0; }

void close_file(Machine& machine, Instance&, PointerCell* pointer) {
  if (pointer == nullptr) return;
  try {
    file_of(pointer).close();
  } catch (const Error& error) {
    machine.warn(std::string("closeFile: ") + error.what());
  }
}

constexpr std::array kFileFunctions = {
    native<open_to_read>("openFileForReading", Reach::Reads),
    native<open_to_write>("openFileForWriting", Reach::Writes),
    native<open_to_append>("openFileForAppending", Reach::Writes),
    native<read_line>("readLine"),
    native<read_whole>("readFileAsString"),
    native<read_delimited>("readDelimitedList"),
    native<read_words>("readWhitespaceDelimitedList"),
    native<write_string>("writeString"),
    native<at_end>("fileEOF"),
    native<close_file>("closeFile"),
};

}  // namespace

std::span<const Native> file_functions() { return kFileFunctions; }

}  // namespace breve::steve
