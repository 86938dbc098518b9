// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

/* A QEMU plugin that counts the instructions between pairs of marker functions. Plugin interface version 1 (QEMU 4.2
 * to 8.x), declared here by hand since Debian ships no header for it.
 *
 *   -plugin libcount_plugin.so,core=1234:1240 -d plugin        begin and end address of the pair `core`, hexadecimal
 *
 *   profile=take                                               where the instructions of the pair `take` are
 *
 * Prints `core passes least mean most` when the emulator ends, and `at address count` for a profile. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef uint64_t plugin_id;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
extern void qemu_plugin_register_vcpu_tb_trans_cb(plugin_id, void (*)(plugin_id, struct qemu_plugin_tb *));
extern size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *);
extern struct qemu_plugin_insn *qemu_plugin_tb_get_insn(const struct qemu_plugin_tb *, size_t);
extern uint64_t qemu_plugin_insn_vaddr(const struct qemu_plugin_insn *);
extern void qemu_plugin_register_vcpu_insn_exec_cb(struct qemu_plugin_insn *, void (*)(unsigned, void *), int, void *);
extern void qemu_plugin_register_vcpu_insn_exec_inline(struct qemu_plugin_insn *, int, void *, uint64_t);
extern void qemu_plugin_register_atexit_cb(plugin_id, void (*)(plugin_id, void *), void *);
extern void qemu_plugin_outs(const char *);
__attribute__((visibility("default"))) int qemu_plugin_version = 1;

struct pair {
  char name[32];
  uint64_t begin, end;
  uint64_t entered, passes, least, most, sum;
};
static struct pair pairs[16];
static int pair_count;
static uint64_t executed;
static char profiled[32];
static int inside;
/* Of the profiled pair, one counter a halfword of the 64 KiB of code. */
static uint64_t executed_at[32768];

static void at_begin(unsigned vcpu, void *data) {
  (void)vcpu;
  ((struct pair *)data)->entered = executed;
  inside = inside || strcmp(((struct pair *)data)->name, profiled) == 0;
}

static void at_instruction(unsigned vcpu, void *data) {
  (void)vcpu;
  if (inside) ++*(uint64_t *)data;
}

static void at_end(unsigned vcpu, void *data) {
  struct pair *pair = data;
  /* The markers' own return and call: see target_bench.cpp, which measures them as the pair `empty`. */
  const uint64_t count = executed - pair->entered;
  (void)vcpu;
  if (strcmp(pair->name, profiled) == 0) inside = 0;
  if (pair->passes == 0 || count < pair->least) pair->least = count;
  if (count > pair->most) pair->most = count;
  pair->sum += count;
  ++pair->passes;
}

static void translated(plugin_id id, struct qemu_plugin_tb *tb) {
  (void)id;
  for (size_t i = 0; i < qemu_plugin_tb_n_insns(tb); ++i) {
    struct qemu_plugin_insn *insn = qemu_plugin_tb_get_insn(tb, i);
    const uint64_t address = qemu_plugin_insn_vaddr(insn);
    for (int p = 0; p < pair_count; ++p) {
      if (address == pairs[p].begin) qemu_plugin_register_vcpu_insn_exec_cb(insn, at_begin, 0, &pairs[p]);
      if (address == pairs[p].end) qemu_plugin_register_vcpu_insn_exec_cb(insn, at_end, 0, &pairs[p]);
    }
    if (profiled[0] != 0 && address / 2 < sizeof executed_at / sizeof executed_at[0]) {
      qemu_plugin_register_vcpu_insn_exec_cb(insn, at_instruction, 0, &executed_at[address / 2]);
    }
    qemu_plugin_register_vcpu_insn_exec_inline(insn, 0, &executed, 1);
  }
}

static void finished(plugin_id id, void *data) {
  (void)id;
  (void)data;
  for (int p = 0; p < pair_count; ++p) {
    char line[256];
    const struct pair *pair = &pairs[p];
    snprintf(line, sizeof line, "%.31s %llu %llu %.1f %llu\n", pair->name, (unsigned long long)pair->passes,
             (unsigned long long)pair->least, pair->passes ? (double)pair->sum / (double)pair->passes : 0.0,
             (unsigned long long)pair->most);
    qemu_plugin_outs(line);
  }
  for (unsigned i = 0; i < sizeof executed_at / sizeof executed_at[0]; ++i) {
    char line[64];
    if (executed_at[i] == 0) continue;
    snprintf(line, sizeof line, "at %x %llu\n", 2 * i, (unsigned long long)executed_at[i]);
    qemu_plugin_outs(line);
  }
}

__attribute__((visibility("default"))) int qemu_plugin_install(plugin_id id, const void *info, int argc, char **argv) {
  (void)info;
  for (int i = 0; i < argc && pair_count < 16; ++i) {
    struct pair *pair = &pairs[pair_count];
    unsigned long long begin, end;
    if (sscanf(argv[i], "profile=%31s", profiled) == 1) continue;
    if (sscanf(argv[i], "%31[^=]=%llx:%llx", pair->name, &begin, &end) != 3) return -1;
    pair->begin = begin & ~1ULL;
    pair->end = end & ~1ULL;
    ++pair_count;
  }
  qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
  qemu_plugin_register_atexit_cb(id, finished, NULL);
  return 0;
}
