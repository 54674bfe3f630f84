# make           builds the experiments        make check     every test (needs libcheck)
# make run       runs them: tables, pictures   make quick     the fast ones: the library's formulas and solver
# make bench     time ratios of the solver     make memcheck  the tests under valgrind
# make gallery   blocks that slide, topple, fall
# make converge  meshes against alpha          make sanitize  the tests under ASan and UBSan

CC      ?= cc
CFLAGS  ?= -O2
STRICT   = -std=c99 -ffp-contract=off -Wall -Wextra -pedantic -Wshadow -Wconversion -Wstrict-prototypes -Wmissing-prototypes
LIBRARY  = bbm contact solver
RUN      = exp1 exp2 exp3
GALLERY  = incline shaken topple column overhang drop impact turning arch resting
CASES    = $(RUN) $(GALLERY)
SHARED   = case plot scene
SUITES   = check_bbm check_contact check_solver check_beyond
HEADERS  = $(wildcard *.h cases/*.h tests/*.h)
O        = out/build
FAILING  = -Dmalloc=test_malloc -Dcalloc=test_calloc -Drealloc=test_realloc
CHECK   := $(shell pkg-config --libs check 2>/dev/null || echo -lcheck -lsubunit -lrt -lpthread)

all: $(CASES:%=$O/%) $O/bench

run: $(RUN:%=$O/%)
	@for c in $(RUN); do $O/$$c || exit 1; done

gallery: $(GALLERY:%=$O/%)
	@for c in $(GALLERY); do $O/$$c || exit 1; done

converge: $O/exp1 $O/exp2
	@for c in exp1 exp2; do $O/$$c converge || exit 1; done

bench: $O/bench
	@$O/bench

$(CASES:%=$O/%): $O/%: $O/cases/%.o $(SHARED:%=$O/cases/%.o) $(LIBRARY:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$O/bench: $O/tests/bench.o $(SHARED:%=$O/cases/%.o) $(LIBRARY:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$O/%.o: %.c $(HEADERS) Makefile
	@mkdir -p $(@D)
	$(CC) $(STRICT) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<

# --- tests: the library once more, with an allocator that can be made to fail ---
$O/failing/%.o: %.c $(HEADERS) Makefile
	@mkdir -p $(@D)
	$(CC) $(STRICT) $(FAILING) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<

$O/tests/check_cases.o: CPPFLAGS += -DBUILD='"$O"'

$O/tests/check_all.o: tests/check_main.c $(HEADERS) Makefile
	@mkdir -p $(@D)
	$(CC) $(STRICT) -DCASES $(CPPFLAGS) $(CFLAGS) -c -o $@ $<

TESTED = $(SUITES:%=$O/tests/%.o) $O/tests/test_alloc.o $(LIBRARY:%=$O/failing/%.o)

$O/quick: $O/tests/check_main.o $(TESTED)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(CHECK) -lm

$O/check: $O/tests/check_all.o $O/tests/check_cases.o $(TESTED)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(CHECK) -lm

$(SUITES:%=$O/tests/%.o) $O/tests/check_main.o $O/tests/check_all.o $O/tests/check_cases.o: | libcheck

libcheck:
	@echo '#include <check.h>' | $(CC) $(CPPFLAGS) -E - >/dev/null 2>&1 || \
	{ echo "The tests need libcheck: apt-get install check (Debian, Ubuntu), or libcheck.github.io/check"; exit 1; }

quick: $O/quick
	$O/quick

check: $O/check $(CASES:%=$O/%)
	$O/check

memcheck: $O/quick
	CK_FORK=no valgrind -q --error-exitcode=1 --leak-check=full --errors-for-leak-kinds=definite,indirect,possible $O/quick

sanitize:
	$(MAKE) O=out/sanitize CFLAGS="-g -O1 -fsanitize=address,undefined -fno-sanitize-recover=all" quick

clean:
	rm -rf out

.PHONY: all run gallery converge bench quick check memcheck sanitize libcheck clean
.DELETE_ON_ERROR:
