// SPDX-License-Identifier: Apache-2.0
// Asks for a token where the service needs one.
import { fill, h } from './dom';
import { signIn } from './session';
import { sentence } from './states';

/** `entered` is called once the service knows the token. */
export function signInForm(root: HTMLElement, entered: () => void): () => void {
  const input = h('input', { id: 'token', type: 'password', autocomplete: 'current-password', required: true,
    'aria-describedby': 'token-hint token-error', spellcheck: 'false' });
  const error = h('p', { id: 'token-error', class: 'error', role: 'alert' });
  const submit = async (event: Event) => {
    event.preventDefault();
    try {
      await signIn(input.value);
    } catch (problem) {
      fill(error, sentence(problem));
      input.focus();
      return;
    }
    entered();
  };
  root.append(h('form', { class: 'sign-in', onsubmit: (event: Event) => void submit(event) },
    h('h1', {}, 'Sign in'),
    h('label', { for: 'token' }, 'Token'), input,
    h('p', { id: 'token-hint', class: 'hint' },
      'Whoever runs the service makes one: ', h('code', {}, 'kidnapwatch token create'),
      '. It is kept until this tab is closed.'),
    error,
    h('button', { type: 'submit', class: 'primary' }, 'Sign in')));
  input.focus();
  return () => undefined;
}
