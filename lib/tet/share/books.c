/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What ranks know of nodes that several of them have: a node's home keeps the books. */
#include "books.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

/* Mail to the homes of the first `count` nodes. */
static tm_status address(tm_mail *mail, const tm_tet_share *share, size_t count,
                         tm_error *error)
{
    unsigned *to = tm_new(count, sizeof *to);
    *mail = (tm_mail){0};
    for (size_t v = 0; v < count && to; v++)
        to[v] = tm_rank_of(share->home, share->number[v]);
    tm_status status = tm_ranks_enough(to, error);
    if (status == TM_OK)
        status = tm_mail_address(mail, to, count, error);
    free(to);
    return status;
}

typedef struct flagged {
    uint32_t number;
    bool flag;
} flagged;

/* At home: the answers to what came. */
static bool *answers(const tm_tet_share *share, const flagged *got, size_t count)
{
    const size_t first = share->home[tm_rank()];
    bool *any = calloc(share->home[tm_rank() + 1] - first + 1, sizeof *any);
    bool *answer = tm_new(count, sizeof *answer);
    for (size_t k = 0; k < count && any; k++)
        any[got[k].number - first] |= got[k].flag;
    for (size_t k = 0; k < count && any && answer; k++)
        answer[k] = any[got[k].number - first];
    if (!any) {
        free(answer);
        answer = NULL;
    }
    free(any);
    return answer;
}

tm_status tm_tet_share_any(const tm_tet_share *share, bool *flag, size_t count,
                           tm_error *error)
{
    tm_mail mail;
    flagged *item = tm_new(count, sizeof *item);
    void *got = NULL, *answer = NULL, *all = NULL;
    for (size_t v = 0; v < count && item; v++)
        item[v] = (flagged){share->number[v], flag[v]};
    tm_status status = address(&mail, share, count, error);
    status =
        tm_ranks_agree(status == TM_OK && !item ? tm_fail_memory(error) : status, error);
    if (status == TM_OK)
        status = tm_mail_send(&mail, item, sizeof *item, &got, error);
    if (status == TM_OK) {
        answer = answers(share, got, mail.got);
        status = tm_ranks_enough(answer, error);
    }
    if (status == TM_OK)
        status = tm_mail_answer(&mail, answer, sizeof *flag, &all, error);
    if (status == TM_OK && count > 0)
        memcpy(flag, all, count * sizeof *flag);
    tm_mail_free(&mail);
    free(item);
    free(got);
    free(answer);
    free(all);
    return status;
}

void tm_share_book_free(tm_share_book *book)
{
    free(book->start);
    free(book->rank);
    *book = (tm_share_book){0};
}

/* Lists the ranks that sent each number of this home. */
static bool fill_book(tm_share_book *book, const tm_tet_share *share,
                      const uint32_t *number, const tm_mail *mail)
{
    const size_t first = share->home[tm_rank()];
    const size_t nodes = share->home[tm_rank() + 1] - first;
    book->start = calloc(nodes + 2, sizeof *book->start);
    book->rank = tm_new(mail->got, sizeof *book->rank);
    if (!book->start || !book->rank)
        return false;
    for (size_t k = 0; k < mail->got; k++)
        book->start[number[k] - first + 2]++;
    for (size_t v = 0; v < nodes; v++)
        book->start[v + 2] += book->start[v + 1];
    size_t k = 0;
    for (unsigned r = 0; r < tm_ranks_count(); r++)
        for (size_t past = k + mail->got_count[r]; k < past; k++)
            book->rank[book->start[number[k] - first + 1]++] = r;
    return true;
}

tm_status tm_share_book_make(tm_share_book *book, const tm_tet_share *share,
                             tm_mail *mail, uint32_t **number, tm_error *error)
{
    void *got = NULL;
    *book = (tm_share_book){0};
    tm_status status = address(mail, share, share->mesh.nodes, error);
    if (status == TM_OK)
        status = tm_mail_send(mail, share->number, sizeof *share->number, &got, error);
    if (status == TM_OK && !fill_book(book, share, got, mail))
        status = tm_fail_memory(error);
    *number = got;
    return tm_ranks_agree(status, error);
}

/* A rank that has a node, too. */
typedef struct sharer {
    uint32_t number;
    unsigned rank;
} sharer;

/* At home: of each number that came, the other ranks that have it. */
static sharer *list_sharers(const tm_tet_share *share, const tm_share_book *book,
                            const uint32_t *number, const tm_mail *mail, size_t *count)
{
    const size_t first = share->home[tm_rank()];
    sharer *list = NULL;
    size_t k = 0, room = 0, all = 0;
    for (unsigned r = 0; r < tm_ranks_count(); r++) {
        count[r] = 0;
        for (size_t past = k + mail->got_count[r]; k < past; k++) {
            const size_t v = number[k] - first;
            for (size_t i = book->start[v]; i < book->start[v + 1]; i++) {
                if (book->rank[i] == r)
                    continue;
                sharer *moved = tm_grow(list, &room, all + 1, sizeof *list);
                if (!moved) {
                    free(list);
                    return NULL;
                }
                list = moved;
                list[all++] = (sharer){number[k], book->rank[i]};
                count[r]++;
            }
        }
    }
    return list ? list : tm_new(0, sizeof *list);
}

/* The ranks that a tetrahedron is for: this one, and those of its nodes; not more than
 * there is room for. */
static size_t ranks_of(const uint32_t node[4], const size_t *start, const sharer *list,
                       unsigned *rank)
{
    size_t ranks = 1;
    rank[0] = tm_rank();
    for (int i = 0; i < 4; i++)
        for (size_t k = start[node[i]]; k < start[node[i] + 1]; k++) {
            size_t j = 0;
            while (j < ranks && rank[j] != list[k].rank)
                j++;
            if (j == ranks)
                rank[ranks++] = list[k].rank;
        }
    return ranks;
}

/* start[v] … start[v + 1]: of node v in the list, which is by numbers. */
static size_t *start_lists(const tm_tet_share *share, const sharer *list, size_t count)
{
    size_t *start = tm_new(share->mesh.nodes + 1, sizeof *start), k = 0;
    for (size_t v = 0; v < share->mesh.nodes && start; v++) {
        start[v] = k;
        while (k < count && list[k].number == share->number[v])
            k++;
    }
    if (start)
        start[share->mesh.nodes] = k;
    return start;
}

/* Each of them its tetrahedra, and this one all. */
static bool widen_deal(tm_tet_deal *deal, const tm_tet_share *share, const uint32_t *key,
                       const sharer *list, size_t count)
{
    const unsigned ranks = tm_ranks_count();
    const tm_tet_mesh *mesh = &share->mesh;
    unsigned *rank = tm_new(ranks, sizeof *rank);
    size_t *start = start_lists(share, list, count);
    size_t *next = calloc(ranks, sizeof *next);
    deal->count = calloc(ranks, sizeof *deal->count);
    bool done = rank && start && next && deal->count;
    for (uint32_t t = 0; t < mesh->slots && done; t++)
        for (size_t k = ranks_of(mesh->tet[t], start, list, rank); k-- > 0;)
            deal->count[rank[k]]++;
    for (unsigned r = 0; r < ranks && done; r++) {
        next[r] = deal->tets;
        deal->tets += deal->count[r];
    }
    deal->tet = tm_new(deal->tets, sizeof *deal->tet);
    deal->key = calloc(deal->tets + 1, sizeof *deal->key);
    done = done && deal->tet && deal->key;
    for (uint32_t t = 0; t < mesh->slots && done; t++)
        for (size_t k = ranks_of(mesh->tet[t], start, list, rank); k-- > 0;) {
            if (key)
                deal->key[next[rank[k]]] = key[t];
            deal->tet[next[rank[k]]++] = t;
        }
    free(rank);
    free(start);
    free(next);
    return done;
}

tm_status tm_share_widen_by(tm_tet_share *share, const tm_share_book *book,
                            const uint32_t *number, const tm_mail *mail,
                            const uint32_t *key, tm_tet_share *to, tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    size_t *count = calloc(ranks, sizeof *count), all = 0;
    void *got = NULL;
    tm_tet_deal deal = {0};
    sharer *list = count ? list_sharers(share, book, number, mail, count) : NULL;
    tm_status status = tm_ranks_enough(list, error);
    if (status == TM_OK)
        status = tm_ranks_exchange(list, count, sizeof *list, &got, count, error);
    free(list);
    for (unsigned r = 0; r < ranks && status == TM_OK; r++)
        all += count[r];
    if (status == TM_OK && !widen_deal(&deal, share, key, got, all))
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = tm_tet_share_deal(share, &deal, to, error);
    tm_tet_deal_free(&deal);
    free(got);
    free(count);
    return status;
}

tm_status tm_tet_share_widen(tm_tet_share *share, const uint32_t *key, tm_tet_share *to,
                             tm_error *error)
{
    tm_share_book book;
    tm_mail mail;
    uint32_t *number;
    tm_status status = tm_share_book_make(&book, share, &mail, &number, error);
    if (status == TM_OK)
        status = tm_share_widen_by(share, &book, number, &mail, key, to, error);
    tm_share_book_free(&book);
    tm_mail_free(&mail);
    free(number);
    return status;
}
