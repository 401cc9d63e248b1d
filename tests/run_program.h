// For tests of the program: runs $PROM_PROGRAM with arguments and keeps what it printed.
#ifndef PROM_TESTS_RUN_PROGRAM_H
#define PROM_TESTS_RUN_PROGRAM_H

#include <dirent.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

typedef struct program_run {
    int code; // exit code, or 128 + signal
    char out[65536], err[65536];
} program_run;

static inline void slurp(const char *path, char *text, size_t size)
{
    FILE *file = fopen(path, "rb");
    size_t n = file ? fread(text, 1, size - 1, file) : 0;
    text[n] = 0;
    if (file) fclose(file);
}

static inline void redirect(int to, const char *path)
{
    int file = open(path, O_CREAT | O_TRUNC | O_WRONLY, 0666);
    if (file < 0 || dup2(file, to) < 0) _exit(126);
    close(file);
}

// `arguments` is split at spaces. Call it inside a scratch folder: the output passes through
// files beside that.
static inline void run_program(program_run *run, const char *arguments)
{
    static unsigned runs;
    char text[1024], out[64], err[64], *argv[64];
    int argc = 0;
    snprintf(text, sizeof text, "%s", arguments);
    snprintf(out, sizeof out, "../run-%d-%u.out", (int)getpid(), ++runs);
    snprintf(err, sizeof err, "../run-%d-%u.err", (int)getpid(), runs);
    argv[argc++] = getenv("PROM_PROGRAM");
    for (char *word = strtok(text, " "); word && argc < 63; word = strtok(NULL, " "))
        argv[argc++] = word;
    argv[argc] = NULL;
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        redirect(1, out);
        redirect(2, err);
        execv(argv[0], argv);
        _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    run->code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    slurp(out, run->out, sizeof run->out);
    slurp(err, run->err, sizeof run->err);
    unlink(out);
    unlink(err);
}

static inline unsigned count_lines(const char *text)
{
    unsigned lines = 0;
    for (; *text; text++) lines += *text == '\n';
    return lines;
}

// Counts (and names on stderr) what a folder holds besides `keep`, a list of names that ends
// with NULL (NULL: none).
static inline unsigned count_others(const char *folder, const char *const *keep)
{
    DIR *dir = opendir(folder);
    unsigned others = 0;
    for (struct dirent *e; dir && (e = readdir(dir));) {
        bool known = e->d_name[0] == '.' && (!e->d_name[1] || e->d_name[1] == '.');
        for (int i = 0; keep && keep[i]; i++) known = known || !strcmp(keep[i], e->d_name);
        if (!known) fprintf(stderr, "left behind: %s/%s\n", folder, e->d_name);
        others += !known;
    }
    if (dir) closedir(dir);
    return others;
}

// A fresh folder under the working folder, which becomes the working folder.
static inline void enter_scratch(void)
{
    char name[] = "cli-XXXXXX";
    if (!mkdtemp(name) || chdir(name) != 0) {
        perror("scratch folder");
        exit(1);
    }
}

static inline void remove_tree(const char *folder)
{
    DIR *dir = opendir(folder);
    for (struct dirent *e; dir && (e = readdir(dir));) {
        char path[1024];
        if (!strcmp(e->d_name, ".") || !strcmp(e->d_name, "..")) continue;
        int n = snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        if (n < 0 || (size_t)n >= sizeof path) continue;
        if (unlink(path) != 0) remove_tree(path);
    }
    if (dir) closedir(dir);
    rmdir(folder);
}

static inline void leave_scratch(void)
{
    char here[1024];
    if (!getcwd(here, sizeof here) || chdir("..") != 0) return;
    remove_tree(here);
}

#endif
