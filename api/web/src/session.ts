// SPDX-License-Identifier: Apache-2.0
// Who am I: the role decides what the pages offer (the service decides what is done).
import { get, keepToken, ME, token, type Me, type Role } from './rest';

const RANK: Record<Role, number> = { viewer: 0, operator: 1, admin: 2 };
let current: Me | undefined;

export function me(): Me | undefined {
  return current;
}

/** Whether the caller's role may do what `role` may. */
export function can(role: Role): boolean {
  return current !== undefined && RANK[current.role] >= RANK[role];
}

export function hasToken(): boolean {
  return token() !== null;
}

/** Asks the service. Throws Problem: 401 where a token is needed. */
export async function identify(): Promise<Me> {
  current = undefined;
  current = await get<Me>(ME);
  return current;
}

/** Throws Problem, and keeps nothing, where the token is not known. */
export async function signIn(secret: string): Promise<Me> {
  keepToken(secret.trim());
  try {
    return await identify();
  } catch (error) {
    keepToken(null);
    throw error;
  }
}

export function signOut(): void {
  keepToken(null);
  current = undefined;
}
