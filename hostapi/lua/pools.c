/* Memory of Lua states: of a world's state, which counts against the world's limit, and of a state in which a file is
   described. Both know how large the longest text and the largest stack are, since one instruction may go through all
   of one: it compares two texts, or passes on all arguments of a function. */
#include <stdlib.h>
#include <string.h>

#include "binding.h"

/* ---- what one instruction may go through -------------------------------------------------------------------------- */

enum { LARGEST = 512 }; /* bytes of a small block; larger ones have a head */

enum { TEXT, STACK, OTHER };

typedef union bl_head {
  unsigned kind; /* one of these */
  double alignment[2];
} head;

static const size_t lightest[] = {8192, 16384}; /* bytes; whatever is smaller takes no more time than an instruction */

static unsigned logarithm(size_t size) {
  unsigned n = 0;
  while ((size >>= 1) != 0) ++n;
  return n;
}

/* Bytes, or less by up to a half. */
static size_t longest(const uint32_t* counts) {
  for (unsigned n = BL_LOGARITHMS; n-- > 0;)
    if (counts[n] != 0) return (size_t)1 << n;
  return 0;
}

static void weigh(bl_weights* weights, unsigned kind, size_t size, int change) {
  if (kind == OTHER || size < lightest[kind]) return;
  const unsigned n = logarithm(size);
  weights->counts[kind][n < BL_LOGARITHMS ? n : BL_LOGARITHMS - 1] += (uint32_t)change;
  weights->most = longest(weights->counts[TEXT]) + longest(weights->counts[STACK]);
}

/* What a new block is for. Lua makes a thread, and its stack next. */
static unsigned kind_of(bl_weights* weights, size_t tag) {
  const bool stack = weights->after_thread;
  weights->after_thread = tag == LUA_TTHREAD;
  weights->fresh = NULL;
  return stack ? STACK : tag == LUA_TSTRING ? TEXT : OTHER;
}

static void note_taken(bl_weights* weights, head* block, unsigned kind, size_t size) {
  block->kind = kind;
  weigh(weights, kind, size, 1);
  weights->fresh = kind == OTHER ? block : NULL;
  weights->fresh_size = size;
}

/* A stack that becomes larger or smaller is copied: a new block is taken, and the old one is given back next. */
static void note_given_back(bl_weights* weights, const head* block, size_t size) {
  weigh(weights, block->kind, size, -1);
  if (block->kind == STACK && weights->fresh) {
    weights->fresh->kind = STACK;
    weigh(weights, STACK, weights->fresh_size, 1);
  }
  weights->fresh = NULL;
}

/* ---- a world's memory: small blocks of a few sizes, kept for the next one of that size ------------------------------- */

enum { STEP = 16, CLASSES = LARGEST / STEP, CHUNK = 32768 };
enum { LONGEST_TEXT = 4 << 20 }; /* bytes, where a budget bounds work */

typedef union chunk {
  union chunk* next;
  double alignment[2];
} chunk;

struct bl_pool {
  breve_world* world;
  chunk* chunks;
  char* room; /* not given out yet, in the last chunk */
  size_t left;
  void* kept[CLASSES];
  bl_world* w;
  uint64_t owed; /* bytes of large blocks that were taken since they were counted last */
  bl_weights weights;
};

bl_pool* bl_pool_new(breve_world* world) {
  bl_pool* pool = (bl_pool*)breve_world_allocate(world, sizeof *pool);
  if (!pool) return NULL;
  memset(pool, 0, sizeof *pool);
  pool->world = world;
  return pool;
}

void bl_pool_destroy(bl_pool* pool) {
  for (chunk* c = pool->chunks; c;) {
    chunk* next = c->next;
    breve_world_release(pool->world, c, CHUNK);
    c = next;
  }
  breve_world_release(pool->world, pool, sizeof *pool);
}

void bl_pool_serve(bl_pool* pool, bl_world* w) { pool->w = w; }

uint64_t bl_pool_owed(bl_pool* pool) {
  const uint64_t owed = pool->owed;
  if (owed < BL_MUCH) return 0;
  pool->owed = 0;
  return owed;
}

size_t bl_pool_weight(const bl_pool* pool) { return pool->weights.most; }

static void* take(bl_pool* pool, size_t size, unsigned kind) {
  if (size > LARGEST) {
    head* large = (head*)breve_world_allocate(pool->world, sizeof *large + size);
    if (!large) return NULL;
    note_taken(&pool->weights, large, kind, size);
    pool->owed += size;
    if (pool->owed >= BL_MUCH && pool->w) bl_look_soon(pool->w);
    return large + 1;
  }
  const size_t number = (size - 1) / STEP, rounded = (number + 1) * STEP;
  void* block = pool->kept[number];
  if (block) {
    memcpy(&pool->kept[number], block, sizeof(void*));
    return block;
  }
  if (pool->left < rounded) {
    chunk* c = (chunk*)breve_world_allocate(pool->world, CHUNK);
    if (!c) return NULL;
    c->next = pool->chunks;
    pool->chunks = c;
    pool->room = (char*)(c + 1);
    pool->left = CHUNK - sizeof *c;
  }
  block = pool->room;
  pool->room += rounded;
  pool->left -= rounded;
  return block;
}

static void give_back(bl_pool* pool, void* block, size_t size) {
  if (size > LARGEST) {
    head* large = (head*)block - 1;
    note_given_back(&pool->weights, large, size);
    breve_world_release(pool->world, large, sizeof *large + size);
    return;
  }
  pool->weights.fresh = NULL;
  void** kept = &pool->kept[(size - 1) / STEP];
  memcpy(block, kept, sizeof(void*));
  *kept = block;
}

void* bl_allocate(void* user, void* block, size_t old_size, size_t new_size) {
  bl_pool* pool = (bl_pool*)user;
  if (!block) { /* the old size is what the block is for */
    const unsigned kind = kind_of(&pool->weights, old_size);
    const bool too_long = kind == TEXT && new_size > LONGEST_TEXT;
    if (new_size == 0 || (too_long && breve_world_has_budget(pool->world))) return NULL;
    return take(pool, new_size, kind);
  }
  if (new_size == 0) {
    give_back(pool, block, old_size);
    return NULL;
  }
  if (old_size <= LARGEST && new_size <= LARGEST && (old_size - 1) / STEP == (new_size - 1) / STEP) return block;
  void* moved = take(pool, new_size, old_size > LARGEST ? ((head*)block - 1)->kind : OTHER);
  if (!moved) return NULL;
  memcpy(moved, block, old_size < new_size ? old_size : new_size);
  give_back(pool, block, old_size);
  return moved;
}

/* ---- memory of a file without a world ------------------------------------------------------------------------------ */

enum { MOST_BYTES = 256 << 20 };

void* bl_allocate_described(void* user, void* block, size_t old_size, size_t new_size) {
  bl_description* d = (bl_description*)user;
  const size_t before = block ? old_size : 0;
  head* old = block ? (head*)block - 1 : NULL;
  const unsigned kind = old ? old->kind : kind_of(&d->weights, old_size);
  if (new_size > before && (new_size > MOST_BYTES || d->used - before > MOST_BYTES - new_size)) return NULL;
  head* moved = new_size == 0 ? NULL : (head*)malloc(sizeof *moved + new_size);
  if (new_size != 0 && !moved) return NULL;
  if (moved) note_taken(&d->weights, moved, kind, new_size);
  if (moved && old) memcpy(moved + 1, block, before < new_size ? before : new_size);
  if (old) note_given_back(&d->weights, old, before);
  free(old);
  d->used = d->used - before + new_size;
  return moved ? moved + 1 : NULL;
}
