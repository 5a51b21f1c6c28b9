/* Functions of the C library that g++ 12's objects use and that are younger than glibc 2.28, in terms
 * of older ones. Part of the modules of wheels only (script/portable), which therefore load on systems
 * from glibc 2.28 on. Source of the versions: symbol versions of Debian's libc6 2.31 and 2.36. */
#define _GNU_SOURCE
#include <pthread.h>
#include <stddef.h>
#include <stdint.h>
#include <time.h>

#define HIDDEN __attribute__((visibility("hidden")))

/* 2.33: before, inline functions that called the following ones. 1: version of struct stat on x86-64. */
struct stat;
extern int __xstat(int version, const char* path, struct stat* out);
extern int __lxstat(int version, const char* path, struct stat* out);
extern int __fxstat(int version, int file, struct stat* out);
extern int __fxstatat(int version, int folder, const char* path, struct stat* out, int flags);
HIDDEN int stat(const char* path, struct stat* out) { return __xstat(1, path, out); }
HIDDEN int lstat(const char* path, struct stat* out) { return __lxstat(1, path, out); }
HIDDEN int fstat(int file, struct stat* out) { return __fxstat(1, file, out); }
HIDDEN int fstatat(int folder, const char* path, struct stat* out, int flags) {
  return __fxstatat(1, folder, path, out, flags);
}

/* 2.32: an optimization of libstdc++; false is always correct. */
HIDDEN char __libc_single_threaded = 0;

/* 2.36: arc4random. */
extern long getrandom(void* buffer, size_t size, unsigned flags);
HIDDEN uint32_t arc4random(void) {
  uint32_t number = 0;
  size_t got = 0;
  while (got < sizeof number) {
    const long more = getrandom((char*)&number + got, sizeof number - got, 0);
    if (more > 0) got += (size_t)more;
  }
  return number;
}

/* 2.29: the same functions without the wrappers that set errno for other standards. */
#define OLDER(name)                                           \
  extern double older_##name(double);                         \
  __asm__(".symver older_" #name "," #name "@GLIBC_2.2.5");   \
  HIDDEN double name(double x) { return older_##name(x); }
OLDER(exp)
OLDER(log)
OLDER(exp2)
OLDER(log2)
extern double older_pow(double, double);
__asm__(".symver older_pow,pow@GLIBC_2.2.5");
HIDDEN double pow(double x, double y) { return older_pow(x, y); }

/* 2.30: waits until a time of another clock; the remaining time is transferred to the real-time clock. */
static struct timespec real_time(clockid_t clock, const struct timespec* until) {
  struct timespec now, real;
  clock_gettime(clock, &now);
  clock_gettime(CLOCK_REALTIME, &real);
  real.tv_sec += until->tv_sec - now.tv_sec;
  real.tv_nsec += until->tv_nsec - now.tv_nsec;
  if (real.tv_nsec < 0) real.tv_nsec += 1000000000, --real.tv_sec;
  if (real.tv_nsec >= 1000000000) real.tv_nsec -= 1000000000, ++real.tv_sec;
  return real;
}

HIDDEN int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock,
                                  const struct timespec* until) {
  const struct timespec real = real_time(clock, until);
  return pthread_cond_timedwait(condition, mutex, &real);
}

HIDDEN int pthread_mutex_clocklock(pthread_mutex_t* mutex, clockid_t clock, const struct timespec* until) {
  const struct timespec real = real_time(clock, until);
  return pthread_mutex_timedlock(mutex, &real);
}
