/* A source of observations that ends as a file tells it: the file `order` in the suite's folder
 * says how and when. Without that file it is sound. It is one source for
 *
 *   a program of Assay's protocol     deaths text | binary | image
 *   a renderer                        deaths row | picture SEED[,SEED] SAMPLES OUT [several]
 *   a library with two samplers       assay_library()
 *
 * so that every kind of source draws the same numbers and dies the same deaths. An order is a line
 * of WAY WHEN PRIMARIES INDEX KEY. WHEN is one of
 *
 *   hello     while it is set up; of a renderer at the picture that shows the size
 *   restart   at the hello of every program but the first
 *   at        at observation INDEX of so many PRIMARIES
 *   pilot     of a renderer: at some pictures of no stream of a test
 *   draw      of a sampler: at observation INDEX of the stream KEY
 *   density, evaluate   of a sampler: at directions near the horizon
 *
 * In a folder with a file `victim` it changes the file that this one names instead, and lives on.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "plugin_abi.h"

/* ---- Orders ---------------------------------------------------------------------------------- */

typedef struct Order {
  char way[16];
  char when[16];
  uint64_t primaries, index, key;
} Order;

static Order read_order(const char* folder) {
  Order order = {"", "", 0, 0, 0};
  char name[4096];
  snprintf(name, sizeof name, "%s/order", folder);
  FILE* file = fopen(name, "r");
  if (!file) return order;
  if (fscanf(file, "%15s %15s %" SCNu64 " %" SCNu64 " %" SCNu64, order.way, order.when,
             &order.primaries, &order.index, &order.key) != 5) {
    order.when[0] = 0;
  }
  fclose(file);
  return order;
}

static int is_now(const Order* order, const char* when) { return !strcmp(order->when, when); }
static int is_way(const Order* order, const char* way) { return !strcmp(order->way, way); }

static int is_at(const Order* order, uint64_t primaries, uint64_t index) {
  return is_now(order, "at") && order->primaries == primaries && order->index == index;
}

/* What stands in reports of every kind, where it must be escaped. */
static const char* const words = "no light <b>&]]></script>\xff\x1b[31m in the lamp";

static void complain(void) { fprintf(stderr, "%s\n", words); }

static void sleep_for_ever(void) {
  for (;;) pause();
}

/* Does to the file that `victim` names what happens to files while they are read. */
static void change(const Order* order) {
  char victim[4096] = "";
  struct stat state;
  FILE* file = fopen("victim", "r");
  if (!file) return;
  if (fscanf(file, "%4095s", victim) == 1 && stat(victim, &state) == 0) {
    if (is_way(order, "shrink") && truncate(victim, state.st_size / 2)) perror(victim);
    if (is_way(order, "empty") && truncate(victim, 0)) perror(victim);
    if (is_way(order, "remove")) unlink(victim);
    if (is_way(order, "scribble")) {
      FILE* scribbled = fopen(victim, "w");
      if (scribbled) fputs("lamp on\n", scribbled), fclose(scribbled);
    }
  }
  fclose(file);
}

/* Ends, or never comes back, unless the way is one of an answer. */
static void end(const Order* order) {
  change(order);
  if (is_way(order, "exit0")) complain(), _exit(0);
  if (is_way(order, "exit3")) complain(), _exit(3);
  if (is_way(order, "kill")) complain(), raise(SIGKILL);
  if (is_way(order, "segv")) {
    complain();
    signal(SIGSEGV, SIG_DFL);
    *(volatile int*)0 = 1;
  }
  if (is_way(order, "abort")) complain(), signal(SIGABRT, SIG_DFL), abort();
  if (is_way(order, "hang")) complain(), sleep_for_ever();
  if (is_way(order, "stop")) complain(), raise(SIGSTOP), sleep_for_ever();
  if (is_way(order, "close")) { /* of a library's host the protocol has descriptors above 2 */
    complain();
    close(1);
    for (int descriptor = 3; descriptor < 64; ++descriptor) close(descriptor);
    sleep_for_ever();
  }
  if (is_way(order, "orphan")) {
    complain();
    if (fork()) _exit(0);
    sleep_for_ever(); /* with the pipes of its parent */
  }
  if (is_way(order, "flood")) {
    static char zeros[65536];
    memset(zeros, '0', sizeof zeros);
    while (write(1, zeros, sizeof zeros) > 0 || errno == EINTR) {
    }
    sleep_for_ever();
  }
  if (is_way(order, "chatter")) {
    for (int line = 0; line < 20000; ++line)
      fprintf(stderr, "%d lamps are on the bridge, all out\n", line);
    complain();
    _exit(3);
  }
}

/* ---- Numbers --------------------------------------------------------------------------------- */

/* The mean of so many uniform numbers. */
static double mean_of(AssayStream* random, uint64_t primaries) {
  double sum = 0;
  for (uint64_t i = 0; i < primaries; ++i) sum += assay_uniform(random);
  return sum / (double)primaries;
}

enum { side = 4, elements = side * side };

/* ---- A program of the protocol ----------------------------------------------------------------
 */

static void say_hello(const Order* order, const char* kind) {
  int dies = is_now(order, "hello");
  if (is_now(order, "restart")) {
    const int first = open("started", O_CREAT | O_EXCL | O_WRONLY, 0666);
    dies = first < 0;
    if (dies) open("restarted", O_CREAT | O_WRONLY, 0666);
  }
  if (dies) {
    if (is_way(order, "short")) complain(), printf("assay 1 "), fflush(stdout), _exit(0);
    if (is_way(order, "garbage")) printf("lamp on\n");
    if (is_way(order, "refuse")) {
      printf("assay 1 text\nerror no light <b>&]]> in the lamp\n");
      fflush(stdout);
      _exit(3);
    }
    end(order);
  }
  printf("assay 1 %s\n", strcmp(kind, "text") ? "binary" : "text");
  if (!strcmp(kind, "image")) {
    printf("image %d %d\nrange 0 1\n", side, side);
  } else {
    printf("channel x low 0 high 1\n");
  }
  printf("averages\nbias unbiased\nready\n");
  fflush(stdout);
  if (dies && is_way(order, "deaf")) close(0), complain(), sleep_for_ever();
}

static int is_text;

static void say_number(double value) {
  if (is_text) {
    printf("%.17g ", value);
  } else {
    fwrite(&value, sizeof value, 1, stdout);
  }
}

static void say_observation(const Order* order, uint64_t key, uint64_t index, uint64_t primaries,
                            int count) {
  AssayStream random = assay_stream(key, index);
  const int dies = is_at(order, primaries, index);
  if (dies) {
    if (is_way(order, "garbage")) fputs("lamp on\n", stdout);
    fflush(stdout);
    end(order);
    if (is_way(order, "short")) return;
  }
  for (int i = 0; i < count; ++i) {
    double value = mean_of(&random, primaries);
    if (dies && is_way(order, "nan")) value = NAN;
    if (dies && is_way(order, "inf")) value = INFINITY;
    if (dies && is_way(order, "beyond")) value = 1.5;
    say_number(value);
  }
  if (dies && is_way(order, "long")) say_number(.5);
  if (is_text) putchar('\n');
}

static int hear_question(uint64_t question[4]) {
  if (!is_text) return fread(question, 8, 4, stdin) == 4;
  uint64_t high;
  const int heard = scanf("%" SCNu64 " %" SCNu64 " %" SCNu64 " %" SCNu64 " %" SCNu64, &high,
                          &question[0], &question[1], &question[2], &question[3]);
  question[0] |= high << 32;
  return heard == 5;
}

static int serve(const char* kind) {
  const Order order = read_order(".");
  const int count = strcmp(kind, "image") ? 1 : elements;
  uint64_t question[4]; /* key, first, count, primaries */
  is_text = !strcmp(kind, "text");
  say_hello(&order, kind);
  while (hear_question(question)) {
    for (uint64_t i = 0; i < question[2]; ++i) {
      say_observation(&order, question[0], question[1] + i, question[3], count);
    }
    if (is_text) {
      printf("%" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 "\n", question[0] >> 32,
             question[0] & 0xffffffff, question[1], question[2], question[3]);
    } else {
      fwrite(question, 8, 4, stdout);
    }
    fflush(stdout);
  }
  return 0;
}

/* ---- A renderer -------------------------------------------------------------------------------
 */

/* An uncompressed OpenEXR picture of one channel, at most `most` bytes of it. */
static void write_picture(FILE* file, const float* texels, int32_t width, int32_t height) {
  static const char head[] = "\x76\x2f\x31\x01\x02\0\0\0";
  fwrite(head, 1, 8, file);
  const int32_t window[4] = {0, 0, width - 1, height - 1};
  const float one = 1, centre[2] = {0, 0};
#define ATTRIBUTE(name, type, size)                          \
  do {                                                       \
    const int32_t length = (int32_t)(size);                  \
    fwrite(name "\0" type, 1, sizeof(name "\0" type), file); \
    fwrite(&length, 4, 1, file);                             \
  } while (0)
  static const char channels[] = "Y\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0";
  ATTRIBUTE("channels", "chlist", sizeof channels + 1);
  fwrite(channels, 1, sizeof channels, file);
  putc(0, file);
  ATTRIBUTE("compression", "compression", 1);
  putc(0, file);
  ATTRIBUTE("dataWindow", "box2i", 16);
  fwrite(window, 4, 4, file);
  ATTRIBUTE("displayWindow", "box2i", 16);
  fwrite(window, 4, 4, file);
  ATTRIBUTE("lineOrder", "lineOrder", 1);
  putc(0, file);
  ATTRIBUTE("pixelAspectRatio", "float", 4);
  fwrite(&one, 4, 1, file);
  ATTRIBUTE("screenWindowCenter", "v2f", 8);
  fwrite(centre, 4, 2, file);
  ATTRIBUTE("screenWindowWidth", "float", 4);
  fwrite(&one, 4, 1, file);
  putc(0, file);
  const int32_t bytes = 4 * width;
  uint64_t place = (uint64_t)ftell(file) + 8 * (uint64_t)height;
  for (int32_t y = 0; y < height; ++y, place += 8 + (uint64_t)bytes) fwrite(&place, 8, 1, file);
  for (int32_t y = 0; y < height; ++y) {
    fwrite(&y, 4, 1, file);
    fwrite(&bytes, 4, 1, file);
    fwrite(texels + y * width, 4, (size_t)width, file);
  }
}

static void render(const Order* order, const char* kind, uint64_t seed, uint64_t samples,
                   const char* out) {
  /* The seed of observation i of a stream is 1 + 630360016 (key + i) mod p. */
  const uint64_t p = 0x7fffffff;
  uint64_t inverse = 1;
  for (uint64_t power = p - 2, base = 630360016; power; power >>= 1, base = base * base % p) {
    if (power & 1) inverse = inverse * base % p;
  }
  const uint64_t offset = ((seed - 1) * inverse % p + p - order->key % p) % p;
  const int dies = (is_now(order, "hello") && samples == 1) || is_at(order, samples, offset) ||
                   (is_now(order, "pilot") && samples == order->primaries && offset > 1000000 &&
                    offset % 8 == 3);
  if (dies) end(order);
  AssayStream random = assay_stream(seed, 0);
  float texels[4 * elements];
  for (int i = 0; i < 4 * elements; ++i) texels[i] = (float)mean_of(&random, samples);
  if (dies && is_way(order, "nan")) texels[0] = NAN;
  if (dies && is_way(order, "inf")) texels[0] = INFINITY;
  if (dies && is_way(order, "nofile")) return;
  FILE* file = fopen(out, "w");
  if (!file) perror(out), _exit(4);
  if (dies && is_way(order, "empty")) {
  } else if (dies && is_way(order, "garbage")) {
    fputs("lamp on\n", file);
  } else if (!strcmp(kind, "row")) {
    fprintf(file, dies && is_way(order, "long") ? "%.9g 0\n" : "%.9g\n", (double)texels[0]);
  } else {
    const int large = dies && is_way(order, "long") ? 2 : 1;
    write_picture(file, texels, side * large, side * large);
    if (dies && is_way(order, "short")) {
      fflush(file);
      if (ftruncate(fileno(file), ftell(file) / 2)) perror(out), _exit(4);
    }
  }
  if (fclose(file)) perror(out), _exit(4);
}

static int render_all(int count, char** arguments) {
  const Order order = read_order(".");
  const uint64_t samples = strtoull(arguments[3], NULL, 10);
  const int several = count > 5;
  for (char* seed = strtok(arguments[2], ","); seed; seed = strtok(NULL, ",")) {
    char out[4096];
    snprintf(out, sizeof out, several ? "%s/%s.exr" : "%s", arguments[4], seed);
    render(&order, arguments[1], strtoull(seed, NULL, 10), samples, out);
  }
  return 0;
}

int main(int count, char** arguments) {
  if (count > 4) return render_all(count, arguments);
  return count == 2 ? serve(arguments[1]) : 2;
}

/* ---- A library --------------------------------------------------------------------------------
 */

static int fail(char* message, size_t size) {
  snprintf(message, size, "%s", words);
  return 4;
}

static int prepare(AssayPreparation* preparation) {
  Order* order = malloc(sizeof *order);
  *order = read_order(preparation->folder);
  preparation->setup = order;
  if (!is_now(order, "hello")) return 0;
  if (is_way(order, "error")) return fail(preparation->message, preparation->message_size);
  end(order);
  return 0;
}

static int secondary(AssayCall* call) {
  const Order* order = call->setup;
  const uint64_t index = call->random->counter[2] | (uint64_t)call->random->counter[3] << 32;
  const int dies = is_at(order, call->primaries, index);
  call->out[0] = mean_of(call->random, call->primaries);
  if (!dies) return 0;
  if (is_way(order, "error")) return fail(call->message, call->message_size);
  if (is_way(order, "print")) puts("lamp on");
  if (is_way(order, "nan")) call->out[0] = NAN;
  if (is_way(order, "inf")) call->out[0] = INFINITY;
  if (is_way(order, "beyond")) call->out[0] = 1.5;
  end(order);
  return 0;
}

static int is_this_draw(const Order* order, const AssayStream* random) {
  if (!is_now(order, "draw")) return 0;
  AssayStream stream = assay_stream(order->key, order->index);
  const uint64_t key = assay_word(&stream);
  const AssayStream drawn = assay_stream(key, assay_word(&stream));
  return !memcmp(drawn.key, random->key, sizeof drawn.key) &&
         !memcmp(drawn.counter + 2, random->counter + 2, 8);
}

static const double pi = 3.14159265358979323846;

static int draw_direction(const void* setup, AssayStream* random, AssayDraw* draw) {
  const Order* order = setup;
  const int dies = is_this_draw(order, random);
  const double u = assay_uniform(random), turn = 2 * pi * assay_uniform(random);
  draw->point[0] = sqrt(u) * cos(turn);
  draw->point[1] = sqrt(u) * sin(turn);
  draw->point[2] = sqrt(1 - u);
  draw->density = draw->point[2] / pi;
  draw->weight = pi;
  if (!dies) return 0;
  if (is_way(order, "error")) return 4;
  if (is_way(order, "print")) puts("lamp on");
  if (is_way(order, "nan")) draw->density = NAN;
  if (is_way(order, "inf")) draw->density = INFINITY;
  if (is_way(order, "beyond")) draw->point[2] = -2;
  end(order);
  return 0;
}

static double told(const Order* order, const char* when, const double* point, double value) {
  if (!is_now(order, when) || point[2] > .3) return value;
  if (is_way(order, "print")) puts("lamp on");
  if (is_way(order, "nan")) return NAN;
  if (is_way(order, "inf")) return INFINITY;
  if (is_way(order, "beyond")) return -1;
  end(order);
  return value;
}

static double density(const void* setup, const double* p) {
  return told(setup, "density", p, p[2] / pi);
}
static double evaluate(const void* setup, const double* p) {
  return told(setup, "evaluate", p, p[2]);
}

static int draw_number(const void* setup, AssayStream* random, AssayDraw* draw) {
  (void)setup;
  draw->point[0] = assay_uniform(random);
  draw->density = draw->weight = 1;
  return 0;
}
static double one(const void* setup, const double* p) { return (void)setup, (void)p, 1; }

static const AssaySampler samplers[] = {{.size = sizeof samplers[0],
                                         .name = "cosine",
                                         .domain = ASSAY_HEMISPHERE,
                                         .sample = draw_direction,
                                         .density = density,
                                         .evaluate = evaluate},
                                        {.size = sizeof samplers[0],
                                         .name = "flat",
                                         .domain = ASSAY_INTERVAL,
                                         .low = 0,
                                         .high = 1,
                                         .sample = draw_number,
                                         .density = one,
                                         .evaluate = one}};
static const AssayChannel x = {
    .size = sizeof x, .name = "x", .flags = ASSAY_LOW | ASSAY_HIGH, .low = 0, .high = 1};
static const AssayEstimator uniform = {.size = sizeof uniform,
                                       .name = "uniform",
                                       .flags = ASSAY_AVERAGES,
                                       .bias = ASSAY_UNBIASED,
                                       .channels = &x,
                                       .channel_count = 1,
                                       .secondary = secondary,
                                       .prepare = prepare,
                                       .release = free,
                                       .samplers = samplers,
                                       .sampler_count = 2};
static const AssayLibrary library = {sizeof library, ASSAY_ABI_VERSION, &uniform, 1};
const AssayLibrary* assay_library(void) { return &library; }
