// Fault injection by LD_PRELOAD: the n-th call of a kind fails, as in SQLite's own tests.
// script/faults drives it. Environment variables:
//
//   TAUT_FAULTS        file of at least sizeof(Record) bytes, shared with the caller: the counts
//   TAUT_FAULT_KIND    memory, write, sync, name, open, truncate, close or read
//   TAUT_FAULT_AT      number of the failing call of that kind, from 1; 0 or unset: count only
//   TAUT_FAULT_STICKY  if not empty, all later calls of that kind also fail, as on a full disk
//   TAUT_FAULT_ERROR   value of errno, or "kill": SIGKILL at that call, after half of the bytes of
//                      a write
//   TAUT_FAULT_LIBRARIES  if set, parts of file names, separated by colons: only allocations by
//                      these libraries count, and counting begins and ends by calls of
//                      taut_faults_begin() and taut_faults_end(). For Python, whose interpreter
//                      must not fail
//
// Else counting begins at main(). Only files on a disk count, without standard error, which the
// program needs for its error messages. Writes of C streams are intercepted at fwrite and similar
// functions, because the C library calls its internal write(), which cannot be replaced.
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "library_code.h"

namespace {

enum Kind { kMemory, kHdf5, kWrite, kSync, kName, kOpen, kTruncate, kClose, kRead, kKinds };
constexpr const char* kNames[kKinds] = {"memory", "hdf5",     "write", "sync", "name",
                                        "open",   "truncate", "close", "read"};

/// Layout of the shared file, read by script/faults
struct Record {
  std::atomic<std::int64_t> calls[kKinds];
  std::atomic<std::int64_t> failed;
  char first[200];  ///< First failed call, as text.
};

Record nobody_looks;
Record* record = &nobody_looks;
int wanted = kKinds;
std::int64_t at = 0;
bool sticky = false, by_kill = false;
int error_number = 0;
std::atomic<bool> counting{false};
void ReadEnvironment() {
  const auto text = [](const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
  };
  const int file = open(text("TAUT_FAULTS"), O_RDWR | O_CLOEXEC);
  if (file >= 0) {
    void* const shared = mmap(nullptr, sizeof(Record), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (shared != MAP_FAILED) record = static_cast<Record*>(shared);
    close(file);
  }
  for (int kind = 0; kind < kKinds; ++kind) {
    if (std::strcmp(text("TAUT_FAULT_KIND"), kNames[kind]) == 0) wanted = kind;
  }
  at = std::strtoll(text("TAUT_FAULT_AT"), nullptr, 10);
  sticky = *text("TAUT_FAULT_STICKY") != '\0';
  by_kill = std::strcmp(text("TAUT_FAULT_ERROR"), "kill") == 0;
  error_number = std::atoi(text("TAUT_FAULT_ERROR"));
  std::strncpy(faults::chosen_names, text("TAUT_FAULT_LIBRARIES"), sizeof faults::chosen_names - 1);
}

/// Counts a call. Returns true, with errno set, if the call must fail.
bool Fails(Kind kind, const char* call, const char* what = "") {
  if (!counting.load(std::memory_order_relaxed)) return false;
  const std::int64_t number = ++record->calls[kind];
  if (kind != wanted || at <= 0 || number < at || (number > at && !sticky)) return false;
  if (number == at) std::snprintf(record->first, sizeof record->first, "%s %s", call, what);
  ++record->failed;
  if (by_kill && kind != kWrite) kill(getpid(), SIGKILL);
  errno = error_number;
  return true;
}

/// Counts an allocation, by its caller.
bool NoMemory(const char* call, const void* caller) {
  if (!counting.load(std::memory_order_relaxed)) return false;
  const auto at_code = reinterpret_cast<std::uintptr_t>(caller);
  if (faults::chosen_names[0] == '\0')
    return Fails(faults::hdf5.Has(at_code) ? kHdf5 : kMemory, call);
  faults::FindNewCode();
  if (faults::hdf5.Has(at_code)) return Fails(kHdf5, call);
  for (int i = 0; i < faults::chosen_count; ++i) {
    if (faults::chosen[i].Has(at_code)) return Fails(kMemory, call);
  }
  return false;
}

/// Counts a call on an open file if the file is on a disk; calls on other files do not fail.
/// Folders count for syncs.
bool Fails(Kind kind, const char* call, int file) {
  if (!counting.load(std::memory_order_relaxed) || file == STDERR_FILENO) return false;
  const int before = errno;
  struct stat info {};
  const bool known = fstat(file, &info) == 0;
  const bool writes = (fcntl(file, F_GETFL) & O_ACCMODE) != O_RDONLY;
  const bool counts = known && (S_ISREG(info.st_mode) ? writes || kind == kRead
                                                      : S_ISDIR(info.st_mode) && kind == kSync);
  errno = before;
  if (!counts) return false;
  char link[64], path[160] = {};
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  if (readlink(link, path, sizeof path - 1) < 0) path[0] = '\0';
  return Fails(kind, call, path);
}

bool Fails(Kind kind, const char* call, std::FILE* stream) {
  return stream != nullptr && Fails(kind, call, fileno(stream));
}

/// Fails a write. To kill the process, first writes half of the bytes.
template <class Half>
ssize_t FailedWrite(const Half& write_half) {
  if (by_kill) {
    write_half();
    kill(getpid(), SIGKILL);
  }
  return -1;
}

int (*program)(int, char**, char**) = nullptr;

int CountedMain(int argc, char** argv, char** environment) {
  counting = faults::chosen_names[0] == '\0';
  return program(argc, argv, environment);
}

}  // namespace

// The C library's function of that name, which this library replaces
#define NEXT(function) \
  static const auto next = reinterpret_cast<decltype(&::function)>(dlsym(RTLD_NEXT, #function))

extern "C" {

int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(),
                      void (*fini)(), void (*rtld_fini)(), void* stack_end) {
  ReadEnvironment();
  dl_iterate_phdr(faults::FindCode, nullptr);
  program = main;
  NEXT(__libc_start_main);
  return next(CountedMain, argc, argv, init, fini, rtld_fini, stack_end);
}

void taut_faults_begin() { counting = true; }
void taut_faults_end() { counting = false; }

// Constructors of static constants have no caller that could handle an exception: the calls of a
// library that a program loads do not count.
void* dlopen(const char* path, int mode) {
  NEXT(dlopen);
  const bool counted = counting.exchange(false);
  void* const library = next(path, mode);
  counting = counted;
  return library;
}

// Memory. Uses the C library's functions under their second names, because dlsym itself may
// allocate.
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  return NoMemory("malloc", __builtin_return_address(0)) ? nullptr : __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  return NoMemory("calloc", __builtin_return_address(0)) ? nullptr : __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  return NoMemory("realloc", __builtin_return_address(0)) ? nullptr : __libc_realloc(old, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  return NoMemory("memalign", __builtin_return_address(0)) ? nullptr
                                                           : __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return NoMemory("aligned_alloc", __builtin_return_address(0)) ? nullptr
                                                                : __libc_memalign(alignment, size);
}
int posix_memalign(void** to, std::size_t alignment, std::size_t size) {
  if (NoMemory("posix_memalign", __builtin_return_address(0))) return ENOMEM;
  *to = __libc_memalign(alignment, size);
  return *to == nullptr ? ENOMEM : 0;
}
// Replaced because the C library would otherwise be the caller of malloc.
char* strdup(const char* text) {
  if (NoMemory("strdup", __builtin_return_address(0))) return nullptr;
  const std::size_t size = std::strlen(text) + 1;
  void* const copy = __libc_malloc(size);
  return copy == nullptr ? nullptr : static_cast<char*>(std::memcpy(copy, text, size));
}

// Writing
ssize_t write(int file, const void* data, std::size_t size) {
  NEXT(write);
  if (!Fails(kWrite, "write", file)) return next(file, data, size);
  return FailedWrite([&] { next(file, data, size / 2); });
}
ssize_t pwrite(int file, const void* data, std::size_t size, off_t place) {
  NEXT(pwrite);
  if (!Fails(kWrite, "pwrite", file)) return next(file, data, size, place);
  return FailedWrite([&] { next(file, data, size / 2, place); });
}
ssize_t pwrite64(int file, const void* data, std::size_t size, off64_t place) {
  return pwrite(file, data, size, place);
}
ssize_t writev(int file, const iovec* parts, int count) {
  NEXT(writev);
  if (!Fails(kWrite, "writev", file)) return next(file, parts, count);
  return FailedWrite([&] { next(file, parts, count / 2); });
}
std::size_t fwrite(const void* data, std::size_t size, std::size_t count, std::FILE* stream) {
  NEXT(fwrite);
  if (!Fails(kWrite, "fwrite", stream)) return next(data, size, count, stream);
  FailedWrite([&] { next(data, size, count / 2, stream); });
  stream->_flags |= 0x20;  // glibc's error flag, for ferror()
  return 0;
}
int fflush(std::FILE* stream) {
  NEXT(fflush);
  if (!Fails(kWrite, "fflush", stream)) return next(stream);
  return static_cast<int>(FailedWrite([] {}));
}
int fclose(std::FILE* stream) {
  NEXT(fclose);
  const bool fails = Fails(kClose, "fclose", stream);
  const int done = next(stream);
  if (!fails) return done;
  errno = error_number;
  return EOF;
}

// Syncing, truncating and closing files
int fsync(int file) {
  NEXT(fsync);
  return Fails(kSync, "fsync", file) ? -1 : next(file);
}
int fdatasync(int file) {
  NEXT(fdatasync);
  return Fails(kSync, "fdatasync", file) ? -1 : next(file);
}
int ftruncate(int file, off_t size) {
  NEXT(ftruncate);
  return Fails(kTruncate, "ftruncate", file) ? -1 : next(file, size);
}
int ftruncate64(int file, off64_t size) { return ftruncate(file, size); }
int close(int file) {
  NEXT(close);
  const bool fails = Fails(kClose, "close", file);
  const int done = next(file);  // a file whose close() fails is closed nevertheless
  if (!fails) return done;
  errno = error_number;
  return -1;
}

// Names in folders
int rename(const char* from, const char* to) {
  NEXT(rename);
  return Fails(kName, "rename", to) ? -1 : next(from, to);
}
int renameat(int from_folder, const char* from, int to_folder, const char* to) {
  NEXT(renameat);
  return Fails(kName, "renameat", to) ? -1 : next(from_folder, from, to_folder, to);
}
int link(const char* from, const char* to) {
  NEXT(link);
  return Fails(kName, "link", to) ? -1 : next(from, to);
}
int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) {
  NEXT(linkat);
  return Fails(kName, "linkat", to) ? -1 : next(from_folder, from, to_folder, to, flags);
}
int mkdir(const char* path, mode_t mode) {
  NEXT(mkdir);
  return Fails(kName, "mkdir", path) ? -1 : next(path, mode);
}
int unlink(const char* path) {
  NEXT(unlink);
  return Fails(kName, "unlink", path) ? -1 : next(path);
}
int unlinkat(int folder, const char* path, int flags) {
  NEXT(unlinkat);
  return Fails(kName, "unlinkat", path) ? -1 : next(folder, path, flags);
}
int remove(const char* path) {
  NEXT(remove);
  return Fails(kName, "remove", path) ? -1 : next(path);
}

// Opening for writing
static bool OpenFails(const char* call, const char* path, int flags) {
  return (flags & O_ACCMODE) != O_RDONLY && std::strncmp(path, "/dev/", 5) != 0 &&
         Fails(kOpen, call, path);
}
static mode_t Mode(int flags, std::va_list more) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
}
int open(const char* path, int flags, ...) {
  NEXT(open);
  std::va_list more;
  va_start(more, flags);
  const mode_t mode = Mode(flags, more);
  va_end(more);
  return OpenFails("open", path, flags) ? -1 : next(path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  std::va_list more;
  va_start(more, flags);
  const mode_t mode = Mode(flags, more);
  va_end(more);
  return open(path, flags, mode);
}
int openat(int folder, const char* path, int flags, ...) {
  NEXT(openat);
  std::va_list more;
  va_start(more, flags);
  const mode_t mode = Mode(flags, more);
  va_end(more);
  return OpenFails("openat", path, flags) ? -1 : next(folder, path, flags, mode);
}
int openat64(int folder, const char* path, int flags, ...) {
  std::va_list more;
  va_start(more, flags);
  const mode_t mode = Mode(flags, more);
  va_end(more);
  return openat(folder, path, flags, mode);
}
int __open_2(const char* path, int flags) { return open(path, flags); }
int __open64_2(const char* path, int flags) { return open(path, flags); }
std::FILE* fopen(const char* path, const char* mode) {
  NEXT(fopen);
  const bool writes = std::strpbrk(mode, "wa+") != nullptr;
  return OpenFails("fopen", path, writes ? O_WRONLY : O_RDONLY) ? nullptr : next(path, mode);
}
std::FILE* fopen64(const char* path, const char* mode) { return fopen(path, mode); }

// Reading
ssize_t read(int file, void* to, std::size_t size) {
  NEXT(read);
  return Fails(kRead, "read", file) ? -1 : next(file, to, size);
}
ssize_t pread(int file, void* to, std::size_t size, off_t place) {
  NEXT(pread);
  return Fails(kRead, "pread", file) ? -1 : next(file, to, size, place);
}
ssize_t pread64(int file, void* to, std::size_t size, off64_t place) {
  return pread(file, to, size, place);
}
ssize_t __read_chk(int file, void* to, std::size_t size, std::size_t) {
  return read(file, to, size);
}
ssize_t __pread64_chk(int file, void* to, std::size_t size, off64_t place, std::size_t) {
  return pread(file, to, size, place);
}

}  // extern "C"
