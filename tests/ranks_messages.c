// Preloaded into assay-mpi, it prints what a rank sends, its memory, and its seconds from a message
// to the next probe. BLOCK_TIMES.RANK gets the processor seconds a block of each reply.
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
static double bytes, messages, taken, reading, begun, last;
static double now(void) { return (double)clock() / CLOCKS_PER_SEC; }
int MPI_Isend(const void* data, int size, MPI_Datatype type, int to, int tag, MPI_Comm comm,
              MPI_Request* request) {
  bytes += size, messages += 1;
  unsigned long long count;
  const char *reply = (const char*)data + 24, *name = getenv("BLOCK_TIMES");  // after the head
  if (name && size > 57 && *reply == 5) {
    static FILE* file;
    char path[4096];
    snprintf(path, sizeof path, "%s.%s", name, getenv("OMPI_COMM_WORLD_RANK"));
    memcpy(&count, reply + 17, 8);  // after kind, batch and seconds
    if (!file) file = fopen(path, "w");
    if (file && last > 0) fprintf(file, "%.9f\n", (now() - last) / (double)count), fflush(file);
    last = now();
  }
  return PMPI_Isend(data, size, type, to, tag, comm, request);
}
int MPI_Improbe(int from, int tag, MPI_Comm comm, int* there, MPI_Message* message,
                MPI_Status* status) {
  if (begun > 0) reading += now() - begun, taken += 1;
  begun = now();
  const int code = PMPI_Improbe(from, tag, comm, there, message, status);
  if (!*there) begun = 0;
  return code;
}
int MPI_Finalize(void) {
  struct rusage used;
  getrusage(RUSAGE_SELF, &used);
  fprintf(stderr, "rank %s: %.0f sent, %.3f MB; %.0f received, %.1f us each; %.0f MB of memory\n",
          getenv("OMPI_COMM_WORLD_RANK"), messages, bytes / 1e6, taken, 1e6 * reading / taken,
          used.ru_maxrss / 1e3);
  return PMPI_Finalize();
}
