#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What a dashboard asks, with curl and jq: dashboard-queries.sh [URL]
# KIDNAPWATCH_TOKEN is sent as bearer token, if it is set.
set -euo pipefail

url=${1:-http://127.0.0.1:8080}
auth=(${KIDNAPWATCH_TOKEN:+-H "Authorization: Bearer $KIDNAPWATCH_TOKEN"})
ask() { curl -fsS --max-time 20 "${auth[@]}" "$@"; }
say() { printf '\n== %s\n' "$*"; }

say 'Can it do its work?'
curl -sS --max-time 20 "$url/readyz" | jq -c .

say 'Robots, those in trouble first'
ask "$url/api/v1/robots" | jq -r '.robots
  | sort_by([.state] | inside(["normal", "unknown"]))[]
  | [.id, .state, .lastScanAt, .incidentId // "-"] | @tsv'

say 'Open incidents, newest first'
ask "$url/api/v1/incidents?state=open" |
  jq -r '.incidents[] | [.id, .robotId, .cause, .openedAt, .explanation] | @tsv'

say 'All incidents, page by page, by robot and state'
next='/api/v1/incidents?limit=100'
while [[ -n $next ]]; do
  page=$(ask "$url$next")
  jq -r '.incidents[] | [.robotId, .state] | @tsv' <<<"$page"
  next=$(jq -r '.next // ""' <<<"$page")
done | sort | uniq -c

latest=$(ask "$url/api/v1/incidents?limit=1" | jq -r '.incidents[0].id // ""')
if [[ -n $latest ]]; then
  say "What incident $latest was concluded from"
  ask "$url/api/v1/incidents/$latest/evidence" | jq -c '{before: (.before.ranges | length),
    after: (.after.ranges | length), scores: (.scores | length)}'
  say 'Who did what about it'
  ask "$url/api/v1/incidents/$latest/history" |
    jq -r '.history[] | [.time, .author, .action, .detail // ""] | @tsv'
fi

robot=$(ask "$url/api/v1/robots" | jq -r '.robots[0].id // ""')
if [[ -n $robot ]]; then
  say "Scores of $robot in the last hour, by minute"
  from=$(date -u -d '1 hour ago' +%FT%TZ)
  ask "$url/api/v1/robots/$robot/scores?from=$from&resolution=60" |
    jq -r '.buckets[] | [.time, .scores, .motion.max // "-", .state] | @tsv'
  say 'The same as a table for a spreadsheet'
  ask -H 'Accept: text/csv' "$url/api/v1/robots/$robot/scores?from=$from&resolution=60" | head -n 3
  say "What is configured for $robot, and where it comes from"
  ask "$url/api/v1/robots/$robot/config" | jq -c '{version, values, origins}'
fi

say 'Scans by what became of them'
ask "$url/api/v1/service" | jq -c '.scans | map_values(select(. > 0))'
