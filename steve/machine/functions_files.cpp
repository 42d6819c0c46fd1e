// Files as scripts see them: lines and whole texts through a pointer (language, section 13). Files that a program
// writes go to the current directory unless their path is absolute; files it reads are looked for by the host too.
#include <array>
#include <cstdio>
#include <memory>

#include "steve/machine/functions.hpp"
#include "steve/machine/machine.hpp"

namespace breve::steve {

namespace {

class FilePointer final : public NativePointer {
 public:
  explicit FilePointer(std::FILE* file) : file_(file) {}
  ~FilePointer() override { close(); }
  FilePointer(const FilePointer&) = delete;
  FilePointer& operator=(const FilePointer&) = delete;

  std::FILE* get() const { return file_; }
  void close() {
    if (file_ != nullptr) std::fclose(file_);
    file_ = nullptr;
  }

 private:
  std::FILE* file_;
};

FilePointer& file_of(PointerCell* pointer) {
  if (pointer == nullptr)
    throw RunError(RunErrorKind::Type, "this file was not opened: the pointer is null",
                   "opening gives null if the file does not exist or may not be read: test the pointer with 'if'");
  auto* file = dynamic_cast<FilePointer*>(pointer->native.get());
  if (file == nullptr) Machine::fail(RunErrorKind::Type, "this pointer is not an open file");
  return *file;
}

std::FILE* open_file(PointerCell* pointer) {
  std::FILE* file = file_of(pointer).get();
  if (file == nullptr) Machine::fail(RunErrorKind::Type, "this file is closed");
  return file;
}

PointerCell* open(Machine& machine, const std::string& path, const char* mode) {
  std::FILE* file = path.empty() ? nullptr : std::fopen(path.c_str(), mode);
  if (file == nullptr) return nullptr;
  return machine.heap().pointer(std::make_unique<FilePointer>(file));
}

PointerCell* open_for_reading(Machine& machine, Instance&, StringCell* name) {
  const std::string path(view(name));
  PointerCell* file = open(machine, path, "rb");
  if (file == nullptr && machine.host().find_file) file = open(machine, machine.host().find_file(path), "rb");
  return file;
}
PointerCell* open_for_writing(Machine& machine, Instance&, StringCell* name) {
  return open(machine, std::string(view(name)), "wb");
}
PointerCell* open_for_appending(Machine& machine, Instance&, StringCell* name) {
  return open(machine, std::string(view(name)), "ab");
}

/// One line without its end, which may be "\n" or "\r\n".
std::string line_of(std::FILE* file) {
  std::string line;
  for (int c = std::getc(file); c != EOF && c != '\n'; c = std::getc(file)) line += static_cast<char>(c);
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return line;
}

StringCell* read_line(Machine& machine, Instance&, PointerCell* pointer) {
  return machine.heap().string(line_of(open_file(pointer)));
}

StringCell* read_whole(Machine& machine, Instance&, PointerCell* pointer) {
  std::FILE* file = open_file(pointer);
  std::string text;
  std::array<char, 4096> buffer;
  for (std::size_t n = 1; n > 0;) {
    n = std::fread(buffer.data(), 1, buffer.size(), file);
    text.append(buffer.data(), n);
  }
  return machine.heap().string(text);
}

void push_text(Heap& heap, ListCell& list, std::string_view text) {
  heap.push(list, Value::of(Tag::String, heap.string(text)));
}

/// Split at every delimiter, which may be several bytes long; none: the line is the only element. "" gives {}.
ListCell* read_delimited(Machine& machine, Instance&, PointerCell* pointer, StringCell* delimiter) {
  const std::string line = line_of(open_file(pointer));
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
  const std::string line = line_of(open_file(pointer));
  ListCell* list = machine.heap().list();
  for (auto start = line.find_first_not_of(kBlanks); start != std::string::npos;) {
    const auto end = line.find_first_of(kBlanks, start);
    push_text(machine.heap(), *list, std::string_view(line).substr(start, end - start));
    start = end == std::string::npos ? end : line.find_first_not_of(kBlanks, end);
  }
  return list;
}

void write_string(Machine& machine, Instance&, PointerCell* pointer, StringCell* text) {
  const std::string_view bytes = view(text);
  if (std::fwrite(bytes.data(), 1, bytes.size(), open_file(pointer)) != bytes.size())
    machine.warn("writeString: the text could not be written, or not whole");
}

std::int32_t at_end(Machine&, Instance&, PointerCell* pointer) { return std::feof(open_file(pointer)) != 0 ? 1 : 0; }

void close_file(Machine&, Instance&, PointerCell* pointer) {
  if (pointer != nullptr) file_of(pointer).close();
}

constexpr std::array kFileFunctions = {
    native<open_for_reading>("openFileForReading"),
    native<open_for_writing>("openFileForWriting"),
    native<open_for_appending>("openFileForAppending"),
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
